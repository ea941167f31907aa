/// Solver/Exact: closed forms, machine precision for any step, where nothing but a uniform field acts: the parabola of the
/// centre of mass and Jacobi's free rotation (plab/free_rotation.h), and for shafts and quantities a constant rate.
/// Groups of another kind are advanced by a stated other method, and an event says so once: RungeKutta4 where joints hold
/// the members, RotationSplitting of order 4 where forces depend on time, place or velocity.
#pragma once

#include "resolved.h"

namespace plab::solvers
{

struct ExactRows
{
    ResolvedColumns resolved;

    void describe(Schema& schema) { resolved.describe(schema); }
};

/// One step over context.dt, from coordinates 0.
void advance_exact(const StepContext& context, Row row, ExactRows& rows, DynamicSystem& system);

/// The closed form itself. False, with system and ledger as they were, if the rates are not uniform after all.
bool advance_in_closed_form(double h, DynamicSystem& system);

}  // namespace plab::solvers
