/// Solver/SemiImplicitEuler: u1 = u0 + h U(t0, x0, u0),  x1 = x0 + h X(x0, u1). Order 1; symplectic where X(x, u) is
/// linear in u and U depends on x alone, so that an oscillator's energy error stays bounded for h w < 2.
/// Source: Hairer, Lubich, Wanner, Geometric numerical integration, section I.1.2, eq. (1.9).
#pragma once

#include "plab/registrar.h"

namespace plab::solvers
{

struct SemiImplicitEulerRows
{
    void describe(Schema&) {}
};

/// One step over context.dt, from coordinates 0.
void advance_semi_implicit_euler(const StepContext& context, Row row, const SemiImplicitEulerRows& rows, DynamicSystem& system);

}  // namespace plab::solvers
