#include "joints/cylindrical.h"

#include <numbers>

namespace plab::constraints
{
namespace
{

/// What a joint with an axis shows of b relative to a.
struct Shown
{
    Axes axes;
    Quat frame_b;                 ///< q_WF
    double twist = 0, speed = 0;  ///< rad, within half a turn; rad/s
};
Shown shown(const Sides& s, const Quat& frame_a, const Quat& frame_b)
{
    Shown out{axes_of(s.a.q * frame_a), s.b.q * frame_b};
    out.twist = twist(out.axes.q, out.frame_b), out.speed = dot(out.axes.n, s.w_ba);
    return out;
}

void add_parallel_axes(const Sides& s, const Shown& at, std::uint32_t feature, RowSink& sink)
{
    add_axis_rows(s, at.axes.n, rotate(at.frame_b, Vec3{0, 0, 1}), at.axes.t1, at.axes.t2, feature, sink);
}

void add_cylindrical_rows(const Sides& s, const Shown& at, RowSink& sink)
{
    sink.add(travel_row(s, at.axes.t1, 0, 0));
    sink.add(travel_row(s, at.axes.t2, 0, 1));
    add_parallel_axes(s, at, 2, sink);
}

double per_radian_of(double lead) { return lead / (2 * std::numbers::pi); }

/// n . d - ahead - lead angle / (2 pi) = 0.
ConstraintRow thread_row(const Sides& s, const Shown& at, double angle, double lead, double ahead)
{
    const double per_radian = per_radian_of(lead);
    const Vec3& n = at.axes.n;
    ConstraintRow row = travel_row(s, n, per_radian * angle + ahead, 4);
    for (RowBlock& block : std::span(row.blocks).first(row.count))
        block.angular += n * (block.participant == s.a.body ? per_radian : -per_radian);
    row.bias += per_radian * dot(cross(s.a.w, n), s.w_ba);
    return row;
}

void finish_along(const StepContext& step, Row row, CylindricalRows& rows, const Bodies& bodies, const RowReports& reports)
{
    const Sides s = rows.sides(row, bodies);
    const Shown at = shown(s, rows.frame_a[row], rows.frame_b[row]);
    rows.keep(row, at.twist, at.speed, step.time, step.dt);
    keep_travel(row, rows, s);
    rows.take_report(row, reports, step.component_of_row[row]);
}

}  // namespace

void CylindricalRows::describe(Schema& s)
{
    describe_pair(s);
    describe_axis(s);
    describe_meter(s, "", "rotation of b relative to a about the axis since the joint was placed");
    describe_travel(s);
    describe_reaction(s, "b");
}

void ScrewRows::describe(Schema& s)
{
    CylindricalRows::describe(s);
    s.param(lead, "lead", unit::metre, "travel of b along the axis for one turn about it; negative: a left-hand thread");
    s.state(start, "start", unit::metre, "travel less that of the turns, where the joint was placed").initially(0);
    s.state(placed_lead, "placed_lead", unit::metre, "the lead parameter then").initially(0);
}

void PlanarRows::describe(Schema& s)
{
    describe_pair(s);
    describe_axis(s);
    describe_meter(s, "", "rotation of b relative to a about the axis since the joint was placed");
    describe_reaction(s, "b");
}

void prepare_cylindrical(Row row, CylindricalRows& rows, const Bodies& bodies)
{
    if (place_travelling(row, rows, bodies)) rows.reset(row);
}

void prepare_screw(Row row, ScrewRows& rows, const Bodies& bodies)
{
    const bool fresh = place_travelling(row, rows, bodies);
    if (fresh) rows.reset(row);
    if (!fresh && rows.placed_lead[row] == rows.lead[row]) return;
    // In place of another joint b stays where it is, however it was turned.
    rows.start[row] = rows.travelled[row] - per_radian_of(rows.lead[row]) * rows.angle[row];
    rows.placed_lead[row] = rows.lead[row];
}

void prepare_planar(Row row, PlanarRows& rows, const Bodies& bodies)
{
    rows.place_points(row, bodies);
    if (rows.place_axis(row, rows.attitude(bodies, rows.a[row]), rows.attitude(bodies, rows.b[row]))) rows.reset(row);
}

void constrain_cylindrical(const StepContext& step, Rows which, const CylindricalRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        sink.begin(step.component_of_row[row]);
        add_cylindrical_rows(s, shown(s, rows.frame_a[row], rows.frame_b[row]), sink);
    }
}

void constrain_screw(const StepContext& step, Rows which, const ScrewRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        const Shown at = shown(s, rows.frame_a[row], rows.frame_b[row]);
        sink.begin(step.component_of_row[row]);
        add_cylindrical_rows(s, at, sink);
        sink.add(thread_row(s, at, rows.read(row, at.twist, at.speed, step.time), rows.lead[row], rows.start[row] - rows.travelled[row]));
    }
}

void constrain_planar(const StepContext& step, Rows which, const PlanarRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        const Shown at = shown(s, rows.frame_a[row], rows.frame_b[row]);
        sink.begin(step.component_of_row[row]);
        sink.add(travel_row(s, at.axes.n, 0, 0));
        add_parallel_axes(s, at, 1, sink);
    }
}

void finish_cylindrical(const StepContext& step, Rows which, CylindricalRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which) finish_along(step, row, rows, bodies, reports);
}

void finish_screw(const StepContext& step, Rows which, ScrewRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which) finish_along(step, row, rows, bodies, reports);
}

void finish_planar(const StepContext& step, Rows which, PlanarRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        const Shown at = shown(s, rows.frame_a[row], rows.frame_b[row]);
        rows.keep(row, at.twist, at.speed, step.time, step.dt);
        rows.point_a[row] += rotate_back(s.a.q, s.d - at.axes.n * dot(at.axes.n, s.d));
        rows.take_report(row, reports, step.component_of_row[row]);
    }
}

}  // namespace plab::constraints
