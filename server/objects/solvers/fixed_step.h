/// Explicit methods with one step per step of the scene: SemiImplicitEuler, StoermerVerlet, RungeKutta4.
///
/// y = (x, u): coordinates and speeds; y' = f(t, y) = (X(x, u), U(t, x, u)), as DynamicSystem presents them.
#pragma once

#include <array>

#include "plab/registrar.h"

namespace plab::solvers
{

/// Solver/SemiImplicitEuler: u1 = u0 + h U(t0, x0, u0),  x1 = x0 + h X(x0, u1). Order 1; symplectic where X(x, u) is
/// linear in u and U depends on x alone, so that an oscillator's energy error stays bounded for h w < 2.
/// Source: Hairer, Lubich, Wanner, Geometric numerical integration, section I.1.2, eq. (1.9).
struct SemiImplicitEulerRows
{
    void describe(Schema&) {}
};

/// One step over context.dt, from coordinates 0.
void advance_semi_implicit_euler(const StepContext& context, Row row, const SemiImplicitEulerRows& rows, DynamicSystem& system);

/// Solver/StoermerVerlet: half a kick, a drift, half a kick (velocity Verlet).
///   v = u0 + h/2 U(0, x0, u0),   x1 = flow of x' = X(x, v) over h,   u1 = v + h/2 U(h, x1, v + h/2 U(0, x0, u0))
/// Order 2 for any forces: forces that depend on velocity are evaluated with the predicted speed at the end, whose error of order h^2
/// enters the result with another factor h. Symplectic if forces depend on position alone and X(x, u) on u alone (shafts, points): then
/// the energy error of an oscillator stays bounded for h w < 2. Rotations drift by the explicit midpoint rule with constant angular
/// momentum: order 2, but not symplectic (RotationSplitting is).
/// Source: Hairer, Lubich, Wanner, "Geometric numerical integration illustrated by the Stoermer-Verlet method", Acta
/// Numerica 12 (2003) 399, eq. (1.18).
struct StoermerVerletRows
{
    void describe(Schema&) {}
};

/// One step over context.dt, from coordinates 0.
void advance_stoermer_verlet(const StepContext& context, Row row, const StoermerVerletRows& rows, DynamicSystem& system);

/// Solver/RungeKutta4: the classical method of order 4, for y = (x, u) and y' = f(t, y):
///   k1 = f(t, y), k2 = f(t + h/2, y + h/2 k1), k3 = f(t + h/2, y + h/2 k2), k4 = f(t + h, y + h k3),
///   y1 = y + h/6 (k1 + 2 k2 + 2 k3 + k4).
/// In the coordinates of DynamicSystem this is the Runge-Kutta-Munthe-Kaas method of order 4 for rotations.
/// Sources: Hairer, Norsett, Wanner, Solving ordinary differential equations I, table II.1.2; Munthe-Kaas, Appl.
/// Numer. Math. 29 (1999).
struct RungeKutta4Rows
{
    void describe(Schema&) {}
};

/// One step over context.dt, from coordinates 0.
void advance_runge_kutta4(const StepContext& context, Row row, const RungeKutta4Rows& rows, DynamicSystem& system);

struct RungeKutta4Stage
{
    double time;        ///< share of h at which this stage is evaluated
    double next;        ///< share of h of this stage's slope in the next stage's point; 0: last stage
    double weight;      ///< share in the result
    double sum_weight;  ///< six times that: exact
};

inline constexpr std::array<RungeKutta4Stage, 4> kRungeKutta4Stages{{
    {0.0, 0.5, 1.0 / 6, 1},
    {0.5, 0.5, 1.0 / 3, 2},
    {0.5, 1.0, 1.0 / 3, 2},
    {1.0, 0.0, 1.0 / 6, 1},
}};

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
