/// Solver/RungeKutta4: the classical method of order 4, for y = (x, u) and y' = f(t, y):
///   k1 = f(t, y), k2 = f(t + h/2, y + h/2 k1), k3 = f(t + h/2, y + h/2 k2), k4 = f(t + h, y + h k3),
///   y1 = y + h/6 (k1 + 2 k2 + 2 k3 + k4).
/// In the coordinates of DynamicSystem this is the Runge-Kutta-Munthe-Kaas method of order 4 for rotations.
/// Sources: Hairer, Norsett, Wanner, Solving ordinary differential equations I, table II.1.2; Munthe-Kaas, Appl.
/// Numer. Math. 29 (1999).
#pragma once

#include "plab/registrar.h"

namespace plab::solvers
{

struct RungeKutta4Rows
{
    void describe(Schema&) {}
};

/// One step over context.dt, from coordinates 0.
void advance_runge_kutta4(const StepContext& context, Row row, const RungeKutta4Rows& rows, DynamicSystem& system);

}  // namespace plab::solvers
