/// One-way coupling: the driven shaft copies the speed of the driver, and the driver feels no reaction.
#pragma once

#include "angular_velocity/coupling_rows.h"

namespace plab::constraints
{

struct AssignRows : CouplingRows
{
    void describe(Schema& s);
};

/// Phase::Couple: rate_b = f rate_a.
void assign_driven(const StepContext& step, Rows which, const AssignRows& rows, ShaftMotion& motion);

}  // namespace plab::constraints
