/// Resolution/LocalRoot: the first zero of the signed gap.
///
/// As long as no overlap is known, it proceeds from the separated side in steps that cannot pass a contact, by the host's bound
/// on how the gap can shrink. Near a contact this bound approaches the rate of the gap itself, so this is Newton's method from
/// the safe side.
///
/// Once an overlap at the end of the bracket is known, it uses cubic Hermite interpolation of the gaps and their rates at both
/// ends, restricted to the bracket, and halves the bracket wherever halving would have come further (as in Oliveira, Takahashi,
/// ACM TOMS 47 (2020): the worst case is that of bisection). The host checks that nothing touched before the zero; if it cannot,
/// it continues with safe steps.
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
    Column<std::int64_t> max_iterations;  // distance queries

    void describe(Schema& schema);
    /// All but max_work.
    void describe_search(Schema& schema);
};
/// Phase::Locate.
void find_root(const StepContext& context, Row row, const RootRows& rows, Trial& trial);

/// Zero of the cubic through (t0, g0 > 0) and (t1, g1 < 0) with slopes r0 and r1 (NaN: slope of the chord), inside (t0, t1).
double hermite_zero(double t0, double g0, double r0, double t1, double g1, double r1);

}  // namespace plab::resolution
