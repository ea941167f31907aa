#include "joints/rigid_joints.h"

namespace plab::constraints
{
void BallRows::describe(Schema& s)
{
    describe_pair(s);
    describe_reaction(s, "b");
}

void HingeRows::describe(Schema& s)
{
    describe_pair(s);
    describe_axis(s);
    describe_meter(s, "", "rotation of b relative to a about the axis since the joint was placed");
    describe_reaction(s, "b");
}

void SliderRows::describe(Schema& s)
{
    describe_pair(s);
    describe_axis(s);
    describe_reaction(s, "b");
    describe_travel(s);
}

void FixedRows::describe(Schema& s)
{
    describe_pair(s);
    s.state(frame_b, "attitude_b", unit::one, "attitude of a (or the world) in b that is maintained");
    s.state(turned, "attitude_taken", unit::one, "that attitude has been taken").initially(false);
    describe_reaction(s, "b");
}

void prepare_ball(Row row, BallRows& rows, const Bodies& bodies) { rows.place_points(row, bodies); }

void prepare_hinge(Row row, HingeRows& rows, const Bodies& bodies)
{
    rows.place_points(row, bodies);
    if (rows.place_axis(row, rows.attitude(bodies, rows.a[row]), rows.attitude(bodies, rows.b[row]))) rows.reset(row);
}

void prepare_slider(Row row, SliderRows& rows, const Bodies& bodies) { place_travelling(row, rows, bodies); }

void prepare_fixed(Row row, FixedRows& rows, const Bodies& bodies)
{
    rows.place_points(row, bodies);
    if (rows.turned[row]) return;
    rows.frame_b[row] = conjugate(bodies.orientation[rows.b[row].index]) * AxisJointRows::attitude(bodies, rows.a[row]);
    rows.turned[row] = true;
}

void constrain_ball(const StepContext& step, Rows which, const BallRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        sink.begin(step.component_of_row[row]);
        add_point_rows(rows.sides(row, bodies), 0, sink);
    }
}

void constrain_hinge(const StepContext& step, Rows which, const HingeRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        const Axes axes = axes_of(s.a.q * rows.frame_a[row]);
        const Vec3 n_b = rotate(s.b.q * rows.frame_b[row], Vec3{0, 0, 1});
        sink.begin(step.component_of_row[row]);
        add_point_rows(s, 0, sink);
        add_axis_rows(s, axes.n, n_b, axes.t1, axes.t2, 3, sink);
    }
}

void constrain_slider(const StepContext& step, Rows which, const SliderRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        const Axes axes = axes_of(s.a.q * rows.frame_a[row]);
        sink.begin(step.component_of_row[row]);
        sink.add(travel_row(s, axes.t1, 0, 0));
        sink.add(travel_row(s, axes.t2, 0, 1));
        add_attitude_rows(s, axes.q, s.b.q * rows.frame_b[row], 2, sink);
    }
}

void constrain_fixed(const StepContext& step, Rows which, const FixedRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        sink.begin(step.component_of_row[row]);
        add_point_rows(s, 0, sink);
        add_attitude_rows(s, s.a.q, s.b.q * rows.frame_b[row], 3, sink);
    }
}

void finish_hinge(const StepContext& step, Rows which, HingeRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        const Quat frame_a = s.a.q * rows.frame_a[row];
        const double speed = dot(rotate(frame_a, Vec3{0, 0, 1}), s.w_ba);
        rows.keep(row, twist(frame_a, s.b.q * rows.frame_b[row]), speed, step.time, step.dt);
        rows.take_report(row, reports, step.component_of_row[row]);
    }
}

void finish_slider(const StepContext& step, Rows which, SliderRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which)
    {
        keep_travel(row, rows, rows.sides(row, bodies));
        rows.take_report(row, reports, step.component_of_row[row]);
    }
}

}  // namespace plab::constraints
