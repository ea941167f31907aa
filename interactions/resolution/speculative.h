/// Resolution/Speculative: no event is located; gaps that may close within the step are contacts too.
#pragma once

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"

namespace plab::resolution
{

/// For responses by rows: a manager lets a gap close and no more, so that bodies stop at the surface. Nothing goes back.
struct SpeculativeRows
{
    Column<double> acceleration;  // m/s^2

    void describe(Schema& schema);
};
/// Phase::Locate: takes the end of the step, as contacts by rows are no events.
void accept_speculation(const StepContext& context, Row row, const SpeculativeRows& rows, Trial& trial);

}  // namespace plab::resolution
