/// Solver/StoermerVerlet: half a kick, a drift, half a kick (velocity Verlet).
///   v = u0 + h/2 U(0, x0, u0),   x1 = flow of x' = X(x, v) over h,   u1 = v + h/2 U(h, x1, v + h/2 U(0, x0, u0))
/// Order 2 for any forces: forces that depend on velocity are evaluated with the predicted speed at the end, whose error of order h^2
/// enters the result with another factor h. Symplectic if forces depend on position alone and X(x, u) on u alone (shafts, points): then
/// the energy error of an oscillator stays bounded for h w < 2. Rotations drift by the explicit midpoint rule with constant angular
/// momentum: order 2, but not symplectic (RotationSplitting is).
/// Source: Hairer, Lubich, Wanner, "Geometric numerical integration illustrated by the Stoermer-Verlet method", Acta
/// Numerica 12 (2003) 399, eq. (1.18).
#pragma once

#include "plab/registrar.h"

namespace plab::solvers
{

struct StoermerVerletRows
{
    void describe(Schema&) {}
};

/// One step over context.dt, from coordinates 0.
void advance_stoermer_verlet(const StepContext& context, Row row, const StoermerVerletRows& rows, DynamicSystem& system);

}  // namespace plab::solvers
