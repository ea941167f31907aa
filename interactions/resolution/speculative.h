/// Resolution/Speculative: locates no events; gaps that may close within the step are treated as contacts as well.
#pragma once

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"

namespace plab::resolution
{

/// Declares the parameter `acceleration`, by which gaps are judged.
void describe_acceleration(Schema& schema, Column<double>& acceleration);

/// For responses by rows: the manager lets a gap close but not overlap, so that bodies stop at the surface. Nothing is rewound.
struct SpeculativeRows
{
    Column<double> acceleration;  // m/s^2

    void describe(Schema& schema);
};
/// Phase::Locate: accepts the end of the step, as contacts by rows are not events.
void accept_speculation(const StepContext& context, Row row, const SpeculativeRows& rows, Trial& trial);

}  // namespace plab::resolution
