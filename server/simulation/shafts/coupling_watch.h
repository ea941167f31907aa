/// Reports pairwise couplings (Phase::Couple) that do not hold: contradictory loops, shafts that nothing can move, trains too long for
/// the sweeps, and one-way drives against one another. Each is reported once, and again only after it held in between.
///
/// The watch changes nothing. Couplings of the constraint graph need no watch, because contradictory ones are refused.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/shafts/shaft_system.h"

namespace plab::simulation
{

/// speed(driven) = factor * speed(driver), enforced by a Couple command.
struct CouplingPair
{
    std::uint32_t component = 0;  ///< directory index
    std::uint32_t driver = 0;     ///< shaft
    std::uint32_t driven = 0;     ///< shaft
    double factor = 1;
    bool one_way = false;  ///< the driver gets no reaction
};

class CouplingWatch
{
public:
    /// A coupling that misses its ratio by more than this share of its speeds is reported.
    static constexpr double kMiss = 1e-9;

    /// To be called after the graph was built. Finds the factor of each row by running its command on test speeds of 1 and 0; rows whose
    /// command does not correct the ratio of two shafts are not watched.
    void rebuild(const world::World& world, const Schedule& schedule, const ConstraintGraph& graph, const ShaftDirectory& directory);
    /// To be called after the speeds were made consistent. `done`: the report of ShaftSystem::solve_speeds. `reported`: by component.
    void report(const world::World& world, const ShaftSystem& system, const CouplingReport& done, double time, EventSink& events,
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

    std::vector<RatioEdge> edges_beside(const ConstraintGraph& graph) const;
    void find_contradictions(const world::World& world, const ConstraintGraph& graph, const ShaftDirectory& directory);
    void report_fault(const Fault& fault, const Shafts& shafts, const CouplingReport& done, std::vector<std::uint8_t>& reported);
    void report_conflict(const world::World& world, const CouplingReport& done, std::vector<std::uint8_t>& reported);
    void check_pair(std::size_t pair, const world::World& world, const ShaftSystem& system, std::vector<std::uint8_t>& reported);
    void report_unsettled(const Shafts& shafts, int sweeps, std::vector<std::uint8_t>& reported);
    void emit(const char* kind, std::uint32_t component, std::string message, std::vector<double> values);
    bool is_faulty(std::uint32_t part, const ShaftSystem& system) const;

    std::vector<CouplingPair> pairs_;
    std::vector<Fault> faults_;
    std::vector<Miss> misses_;
    double time_ = 0;
    EventSink* events_ = nullptr;
};

}  // namespace plab::simulation
