/// The measured properties that decide which method is suitable for a group.
#pragma once

#include "fixed_step.h"
#include "flat_system.h"

namespace plab::solvers
{

/// The largest angular speed of a body, rad/s.
double fastest_spin(DynamicSystem& system);

/// The stiffness along a step of RungeKutta4, estimated from its slopes without further evaluations. Differences of the slopes form a
/// power iteration, d1 = k2 - k1, d2 = k3 - k2 = (h/2) J d1, d3 = k4 - 2 k3 + k1 = h J d2, so |h lambda|^2 is about 2 |d3| / |d1|
/// (Hairer, Wanner, Solving ordinary differential equations II, eq. (IV.2.26), use this for other methods). Each body and shaft is judged
/// separately, in the norm |du| + |dx| / h, so that a stiff one is not hidden by larger motions of others; quantities are judged
/// together. Rates that are small compared with those of the others, or at rounding level, do not count.
struct Stiffness
{
    double value = 0;       ///< |h lambda|, the largest value found; infinite if slopes are not finite
    bool too_much = false;  ///< for some member: above 0.5, and above 4 |w| h
};
/// With `each_alone` each member is judged as if there were no others; what passes then also passes in any group.
Stiffness stiffness_of(DynamicSystem& system, double h, const StageSlopes& slopes, bool each_alone = false);

/// Working vectors of probe().
struct ProbeMemory
{
    std::vector<double> y, first, rates, change, units;
};
/// What 16 short Euler steps show of forces that may jump.
struct Probed
{
    bool slides = false;  ///< they jump to and fro: accelerations are close to one of two values, and change between them both ways
    bool grows = true;    ///< changes grow from step to step: forces are stiff, and no explicit step of this length is stable
};
/// Steps of `length`, s, from `from` on, where the state is `y` (FlatSystem). Leaves the system in another state. Where the motion follows
/// a line from both sides of which forces push it back (a sliding mode), it slides.
Probed probe(double from, std::span<const double> y, double length, ProbeMemory& memory, DynamicSystem& system);

}  // namespace plab::solvers
