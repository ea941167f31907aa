/// Limit: keeps the coordinate, or the distance between the points, within [lower, upper]; and the rows of whatever else has bounds.
///
///   error = x - lower, or upper - x        one-sided rows, emitted only where they may act within the step
///
/// Rows are emitted before they can act: when the distance to a bound is less than an activation distance, or at twice the time that the
/// present speed needs to reach it. A bound that is reached unexpectedly acts in the next step.
#pragma once

#include "joints/motor.h"

namespace plab::constraints
{

struct LimitRows : CoordinateRows, ReactionColumns
{
    Column<double> lower, upper, restitution;
    Column<Ref> manager;
    void describe(Schema& s);
};
Result<void> prepare_limit(Row row, LimitRows& rows, const Bodies& bodies);
void constrain_limit(const StepContext& step, Rows which, const LimitRows& rows, const Bodies& bodies, const Shafts& shafts, RowSink& sink);

/// m: a fraction of the smallest radius of gyration of some bodies; 0 if none of them moves.
double activation_by_size(const Bodies& bodies, std::span<const Ref> some);
/// The row of a bound that is near: `row` is that of the distance to it, `gap` (m or rad), which changes at `speed`. `activation`: m or
/// rad.
void add_bound(const StepContext& step, ConstraintRow row, double gap, double speed, double activation, double restitution, RowSink& sink);
/// The same row for the negative coordinate.
ConstraintRow opposite(ConstraintRow row);

}  // namespace plab::constraints
