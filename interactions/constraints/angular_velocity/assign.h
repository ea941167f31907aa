/// One way: the driven shaft turns as the driver says, and the driver feels nothing.
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
