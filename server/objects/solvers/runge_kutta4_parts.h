/// RungeKutta4 in parts of a step, for groups that one step would not resolve and that are too large for implicit methods.
#pragma once

#include "fixed_step.h"
#include "reports.h"

namespace plab::solvers
{

/// Divides h into `parts` and makes a step of RungeKutta4 in each. The slopes of a part tell whether it was short enough (stiffness.h); if
/// not, it is undone, and what remains is divided twice as finely. So the errors are those of RungeKutta4 where it is not stiff. Where even
/// a quarter of a part would be too long, because something faster begins or a force jumps, it ends there: `reached` is before h. Uses
/// workspaces 0 to 11.
SubstepCounts advance_by_runge_kutta4_parts(double h, std::int64_t parts, DynamicSystem& system);
/// The rest of a step h that is done until `from`, in `parts` whose error nothing controls.
void finish_by_runge_kutta4(double h, double from, std::int64_t parts, DynamicSystem& system);

}  // namespace plab::solvers
