/// World-sized working arrays of a solver stage, shared by all group systems of one thread: a system borrows them while
/// it advances, so that it is itself no larger than its members.
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
    /// To the sizes of the world. Nobody is active afterwards.
    void fit(const world::World& world);

    /// Who is advanced: flags by host row. Whoever was active before is not any more.
    void activate(const void* owner, std::uint64_t configuration, std::span<const std::uint32_t> bodies,
                  std::span<const std::uint32_t> shafts);
    bool is_active(const void* owner, std::uint64_t configuration) const { return owner_ == owner && configuration_ == configuration; }
    void book_body(std::uint32_t b) { accounted_bodies[b] = 1; }
    void book_shaft(std::uint32_t s) { accounted_shafts[s] = 1; }

    Wrenches wrenches;
    std::vector<double> power;  ///< W by component; all zero between uses
    std::vector<std::uint8_t> active_bodies, active_shafts, accounted_bodies, accounted_shafts;
    std::uint64_t evaluations = 0;  ///< of forces, in this step
    std::int64_t rows_ns = 0;       ///< of an advance: what its joints took, until they share it

    /// Of the thread that advances with this.
    CostMeter& meter() { return *meter_; }
    void measure_with(CostMeter& meter) { meter_ = &meter; }

private:
    void deactivate();

    CostMeter own_meter_;
    CostMeter* meter_ = &own_meter_;
    const void* owner_ = nullptr;
    std::uint64_t configuration_ = 0;
    std::vector<std::uint32_t> set_bodies_, set_shafts_;
};

}  // namespace plab::simulation
