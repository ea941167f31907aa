/// Joints between two bodies, or a body and the world: Ball, Hinge, Slider, Fixed.
///
/// One family: they have the same roles and points, so that a request can replace one by another.
///
///   Ball     p_b = p_a                                     3 rows
///   Hinge    p_b = p_a, n_b along n_a                      5 rows, free: angle about n
///   Slider   t1 . d = t2 . d = 0, no turn                  5 rows, free: travel n . d
///   Fixed    p_b = p_a, no turn                            6 rows
#pragma once

#include "joints/pair.h"

namespace plab::constraints
{

struct BallRows : JointRows
{
    void describe(Schema& s);
};
struct HingeRows : AxisJointRows, MeterColumns
{
    void describe(Schema& s);
};
struct SliderRows : AxisJointRows, TravelColumns
{
    void describe(Schema& s);
};
struct FixedRows : JointRows
{
    Column<Quat> frame_b;  // q_ab when the joint was placed
    Column<bool> turned;
    void describe(Schema& s);
};

// Phase::Prepare.
void prepare_ball(Row row, BallRows& rows, const Bodies& bodies);
void prepare_hinge(Row row, HingeRows& rows, const Bodies& bodies);
void prepare_slider(Row row, SliderRows& rows, const Bodies& bodies);
void prepare_fixed(Row row, FixedRows& rows, const Bodies& bodies);
// Phase::Constrain.
void constrain_ball(const StepContext& step, Rows which, const BallRows& rows, const Bodies& bodies, RowSink& sink);
void constrain_hinge(const StepContext& step, Rows which, const HingeRows& rows, const Bodies& bodies, RowSink& sink);
void constrain_slider(const StepContext& step, Rows which, const SliderRows& rows, const Bodies& bodies, RowSink& sink);
void constrain_fixed(const StepContext& step, Rows which, const FixedRows& rows, const Bodies& bodies, RowSink& sink);
// Phase::Finish.
void finish_hinge(const StepContext& step, Rows which, HingeRows& rows, const Bodies& bodies, const RowReports& reports);
void finish_slider(const StepContext& step, Rows which, SliderRows& rows, const Bodies& bodies, const RowReports& reports);

}  // namespace plab::constraints
