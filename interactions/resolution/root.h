/// Resolution/LocalRoot: the zero of the signed gap, in a bracket that holds the first one.
///
/// No overlap known: steps from the clear side that cannot pass a contact, by the host's bound on how the gap can shrink.
/// Close to a contact that bound is the rate of the gap itself, so this is Newton's method on the safe side.
/// Overlap known at the end: cubic Hermite interpolation through gaps and rates at both ends of the bracket, kept inside it,
/// with halving wherever that would have come further (as in Oliveira, Takahashi, ACM TOMS 47 (2020): the worst case of bisection).
/// The host checks that nothing met before; if it cannot, it goes on with safe steps.
#pragma once

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"

namespace plab::resolution
{

struct RootRows
{
    Column<double> time_tolerance;        // s
    Column<double> max_work;              // 1
    Column<std::int64_t> max_iterations;  // looks

    void describe(Schema& schema);
};
/// Phase::Locate.
void find_root(const StepContext& context, Row row, const RootRows& rows, Trial& trial);

/// Zero of the cubic through (t0, g0 > 0) and (t1, g1 < 0) with slopes r0 and r1 (NaN: the chord's), inside (t0, t1).
double hermite_zero(double t0, double g0, double r0, double t1, double g1, double r1);

}  // namespace plab::resolution
