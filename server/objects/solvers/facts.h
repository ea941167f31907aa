/// What decides which method fits a group.
#pragma once

#include "flat_system.h"
#include "runge_kutta4.h"

namespace plab::solvers
{

/// The largest angular speed of a body, rad/s.
double fastest_spin(DynamicSystem& system);

/// How stiff the equations look along a step of RungeKutta4, from its slopes alone: no evaluation more. Differences of the
/// slopes are a power iteration, d1 = k2 - k1, d2 = k3 - k2 = (h/2) J d1, d3 = k4 - 2 k3 + k1 = h J d2, so |h lambda|^2 is
/// about 2 |d3| / |d1| (Hairer, Wanner, Solving ordinary differential equations II, eq. (IV.2.26), does so for other
/// methods). Each body and shaft is judged by itself, in the norm |du| + |dx| / h, for a stiff one shall not hide behind what
/// moves more; quantities are judged together. Rates that are small against those of the others, or rounding, do not count.
struct Stiffness
{
    double value = 0;       ///< |h lambda|, the largest found; infinite where slopes are not finite
    bool too_much = false;  ///< of some member: above 0.5, and above 4 |w| h
};
/// With `each_alone` members are judged as if there were no others: what passes then passes in any company.
Stiffness stiffness_of(DynamicSystem& system, double h, const StageSlopes& slopes, bool each_alone = false);

}  // namespace plab::solvers
