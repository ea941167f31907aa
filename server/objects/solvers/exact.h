/// Solver/Exact: closed forms with machine precision at any step, if nothing but a uniform field acts: the parabola of the centre of
/// mass, Jacobi's free rotation (plab/free_rotation.h), and a constant rate for shafts and quantities. Other groups are advanced by
/// another method, which an event reports once: RungeKutta4 if joints constrain the members, RotationSplitting of order 4 if forces
/// depend on time, position or velocity.
#pragma once

#include "reports.h"

namespace plab::solvers
{

struct ExactRows
{
    ResolvedColumns resolved;

    void describe(Schema& schema) { resolved.describe(schema); }
};

/// One step over context.dt, from coordinates 0.
void advance_exact(const StepContext& context, Row row, ExactRows& rows, DynamicSystem& system);

/// The closed form itself. Returns false, with system and ledger unchanged, if the rates turn out not to be uniform.
bool advance_in_closed_form(double h, DynamicSystem& system);

}  // namespace plab::solvers
