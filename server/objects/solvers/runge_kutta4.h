/// Solver/RungeKutta4: the classical method of order 4, for y = (x, u) and y' = f(t, y):
///   k1 = f(t, y), k2 = f(t + h/2, y + h/2 k1), k3 = f(t + h/2, y + h/2 k2), k4 = f(t + h, y + h k3),
///   y1 = y + h/6 (k1 + 2 k2 + 2 k3 + k4).
/// In the coordinates of DynamicSystem this is the Runge-Kutta-Munthe-Kaas method of order 4 for rotations.
/// Sources: Hairer, Norsett, Wanner, Solving ordinary differential equations I, table II.1.2; Munthe-Kaas, Appl.
/// Numer. Math. 29 (1999).
#pragma once

#include <array>

#include "plab/registrar.h"

namespace plab::solvers
{

struct RungeKutta4Rows
{
    void describe(Schema&) {}
};

/// One step over context.dt, from coordinates 0.
void advance_runge_kutta4(const StepContext& context, Row row, const RungeKutta4Rows& rows, DynamicSystem& system);

/// The slopes k1 to k4 of a step, in the system's workspaces 3 to 10, for callers that judge the step and may undo it.
struct StageSlopes
{
    explicit StageSlopes(DynamicSystem& system);

    std::array<std::span<double>, 4> dx, du;
};

/// The method itself; uses workspaces 0 to 2. Stores the slopes if requested.
void advance_by_runge_kutta4(double h, DynamicSystem& system, StageSlopes* slopes = nullptr);
/// Computes only the slopes: nothing is booked, and the system is left as it was.
void find_slopes(double h, DynamicSystem& system, StageSlopes& slopes);
/// Returns to the start after an advance with slopes, and cancels its bookings.
void take_back_runge_kutta4(double h, DynamicSystem& system, const StageSlopes& slopes);

}  // namespace plab::solvers
