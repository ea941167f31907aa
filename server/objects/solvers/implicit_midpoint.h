/// Solver/ImplicitMidpoint:  Z = y0 + h/2 f(h/2, Z),  y1 = 2 Z - y0.
/// Order 2, symmetric, A-stable: stiffness never makes it unstable, and is not damped either (an oscillation that the step does not
/// resolve remains, slowed down). Symplectic where x' = u; conserves quadratic invariants of linear systems. Z is found by fixed-point
/// iteration while that contracts well, else by simplified Newton steps with a Jacobian by differences. If neither converges the step is
/// halved, up to 64 parts; if that fails too, the event solver.failed reports it and the rest of the step is not made.
/// Source: Hairer, Lubich, Wanner, Geometric numerical integration, eq. (II.1.5) and section VIII.6.
#pragma once

#include "flat_system.h"
#include "plab/registrar.h"

namespace plab::solvers
{

struct ImplicitMidpointMemory
{
    std::vector<double> y, z, f, update, units, sizes, scale, work, slope, other, wide;
    SquareMatrix<double> jacobian;
    Factors<double> factors;

    void fit(std::size_t n);
};

struct ImplicitMidpointRows
{
    Column<double> relative_tolerance;
    Column<std::int64_t> iterations, substeps, evaluations;
    Column<ImplicitMidpointMemory> memory;

    void describe(Schema& schema);
};

/// One step over context.dt, from coordinates 0.
void advance_implicit_midpoint(const StepContext& context, Row row, ImplicitMidpointRows& rows, DynamicSystem& system);

}  // namespace plab::solvers
