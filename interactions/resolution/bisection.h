/// Resolution/*: finds the time of impact within a step that ends in an overlap.
#pragma once

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"

namespace plab::resolution
{

/// No location: an impact is answered at the end of the step in which it is detected.
struct NoneRows
{
    void describe(Schema&) {}
};
void accept_end(const StepContext& context, Row row, const NoneRows& rows, Trial& trial);

/// Halves the bracket [begin, end]: the bodies are separated at begin and overlap at end. After n trials its length is h 2^-n.
struct BisectionRows
{
    Column<double> time_tolerance;        // s
    Column<double> max_work;              // 1
    Column<std::int64_t> max_iterations;  // trials

    void describe(Schema& schema);
};
/// Phase::Locate. Resolution/Bisection rewinds the whole world for each trial (as in the paper), Resolution/LocalBisection only
/// the group of touching bodies.
void bisect(const StepContext& context, Row row, const BisectionRows& rows, Trial& trial);

}  // namespace plab::resolution
