/// World-sized working arrays of a solver stage, shared by all group systems of one thread. A system borrows them while it advances, so
/// its own size is only that of its members.
#pragma once

#include <vector>

#include "plab/wrenches.h"
#include "simulation/costs/cost_meter.h"
#include "world/world.h"

namespace plab::simulation
{

class StageScratch
{
public:
    /// Resizes the arrays for the world. Nothing is active afterwards.
    void fit(const world::World& world);

    /// A number that no configuration of any system has had. An address would not tell them apart: a system that is gone leaves its own to
    /// the next one.
    std::uint64_t new_configuration() { return ++configurations_; }
    /// Sets the flags, by host row, of the objects that are advanced, and clears those of the previous configuration.
    void activate(std::uint64_t configuration, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> shafts);
    bool is_active(std::uint64_t configuration) const { return active_ == configuration; }
    /// Those members of a list of participants, in its order, that are active.
    void list_active(const RefList& all, RefList& out);
    void book_body(std::uint32_t b) { accounted_bodies[b] = 1; }
    void book_shaft(std::uint32_t s) { accounted_shafts[s] = 1; }

    Wrenches wrenches;
    Bodies moved_bodies;         ///< position, velocity and angular velocity alone: with which forces are booked
    Shafts moved_shafts;         ///< speed alone
    std::vector<double> speeds;  ///< in the form of DynamicSystem::speeds()
    std::vector<double> power;   ///< W by component; all zero between uses
    std::vector<std::uint8_t> active_bodies, active_shafts, accounted_bodies, accounted_shafts;
    std::uint64_t evaluations = 0;  ///< of forces, in this step
    std::uint64_t held_bodies = 0;  ///< bodies that joints held in an evaluation, summed over these, in this step
    std::int64_t rows_ns = 0;       ///< ns of the present advance that its joints took, until divided among them

    /// The meter of the thread that uses these arrays.
    CostMeter& meter() { return *meter_; }
    void measure_with(CostMeter& meter) { meter_ = &meter; }

private:
    /// Where the objects of a long list of participants are in it; kNoIndex: not there.
    struct Places
    {
        const RefList* all = nullptr;
        std::vector<std::uint32_t> of_body, of_shaft;  ///< by host row
        std::vector<std::uint32_t> others;             ///< of all other participants, which count as active
    };
    void deactivate();
    const Places& places_in(const RefList& all);

    CostMeter own_meter_;
    CostMeter* meter_ = &own_meter_;
    std::uint64_t configurations_ = 0;
    std::uint64_t active_ = 0;  ///< configuration of the system to which the flags belong; 0: none
    std::vector<std::uint32_t> set_bodies_, set_shafts_;
    std::vector<Places> places_;
    std::vector<std::uint32_t> found_;
};

}  // namespace plab::simulation
