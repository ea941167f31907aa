/// Universal: a cross whose one axis is fixed in a and whose other one in b (Cardan's or Hooke's joint). It belongs to the family of
/// rigid_joints.h.
///
///   p_b = p_a, n_a . n_b = c        4 rows, free: the angles about n_a and n_b; c: at the pose at which the joint was placed
#pragma once

#include "joints/pair.h"

namespace plab::constraints
{

struct UniversalRows : JointRows
{
    Column<Vec3> axis, axis_b;        // W, at the pose at which the joint is placed
    Column<Vec3> own_a, own_b;        // the first in the frame of a, the second in that of b
    Column<Vec3> other_a, other_b;    // the second in the frame of a, the first in that of b, when the joint was placed
    Column<Vec3> placed_a, placed_b;  // the parameters from which they were taken
    MeterColumns about_a, about_b;
    void describe(Schema& s);
};

/// Phase::Prepare. Refuses axes that are parallel.
Result<void> prepare_universal(Row row, UniversalRows& rows, const Bodies& bodies);
/// Phase::Constrain.
void constrain_universal(const StepContext& step, Rows which, const UniversalRows& rows, const Bodies& bodies, RowSink& sink);
/// Phase::Finish.
void finish_universal(const StepContext& step, Rows which, UniversalRows& rows, const Bodies& bodies, const RowReports& reports);

}  // namespace plab::constraints
