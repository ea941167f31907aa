/// Pairwise couplings (Phase::Couple) that do not hold: loops that contradict themselves, shafts that nobody can move, trains
/// too long for the sweeps, one-way drives against one another. Told once, and anew only when it ended and came back.
///
/// It changes nothing. The constraint graph's own couplings need no watch: what cannot hold among them is refused.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/shafts/shaft_system.h"

namespace plab::simulation
{

/// speed(driven) = factor * speed(driver), which a Couple command brings about.
struct CouplingPair
{
    std::uint32_t component = 0;  ///< directory index
    std::uint32_t driver = 0;     ///< shaft
    std::uint32_t driven = 0;     ///< shaft
    double factor = 1;
    bool one_way = false;  ///< the driver feels nothing
};

class CouplingWatch
{
public:
    /// Couplings that miss their ratio by more than this share of their speeds are told of.
    static constexpr double kMiss = 1e-9;

    /// After the graph was built. Learns each row's factor by asking its command for a correction of speeds 1 and 0; rows that
    /// do not correct a ratio of two shafts are not watched.
    void rebuild(const world::World& world, const Schedule& schedule, const ConstraintGraph& graph, const ShaftDirectory& directory);
    /// After speeds were brought together: `done` is what ShaftSystem::solve_speeds reported. `told` by component.
    void tell(const world::World& world, const ShaftSystem& system, const CouplingReport& done, double time, EventSink& events,
              std::vector<std::uint8_t>& reported);

private:
    struct Fault
    {
        std::size_t pair = 0;
        std::string why;
    };
    struct Miss
    {
        std::uint32_t part = 0;
        double share = 0;  ///< of the speeds
        std::size_t pair = 0;
    };

    void find_contradictions(const world::World& world, const ConstraintGraph& graph, const ShaftDirectory& directory);
    void tell_fault(const Fault& fault, const Shafts& shafts, const CouplingReport& done, std::vector<std::uint8_t>& reported);
    void tell_conflict(const world::World& world, const CouplingReport& done, std::vector<std::uint8_t>& reported);
    void look_at(std::size_t pair, const world::World& world, const ShaftSystem& system, std::vector<std::uint8_t>& reported);
    void tell_unsettled(const Shafts& shafts, int sweeps, std::vector<std::uint8_t>& reported);
    void emit(const char* kind, std::uint32_t component, std::string message, std::vector<double> values);
    bool is_faulty(std::uint32_t part, const ShaftSystem& system) const;

    std::vector<CouplingPair> pairs_;
    std::vector<Fault> faults_;
    std::vector<Miss> misses_;
    double time_ = 0;
    EventSink* events_ = nullptr;
};

}  // namespace plab::simulation
