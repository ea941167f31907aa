#include "joints/pulley.h"

#include <array>

#include "joints/limit.h"

namespace plab::constraints
{

void PulleyRows::describe(Schema& s)
{
    s.role(a, "a", {Facet::Body}, "the body at one end").writes();
    s.role(b, "b", {Facet::Body}, "the body at the other end").writes();
    s.role(carrier, "carrier", {Facet::Body}, "the body that carries both wheels; none: the world").optional().writes();
    s.param(anchor_a, "anchor_a", unit::metre, "where the rope ends, in the frame of a").or_else({});
    s.param(anchor_b, "anchor_b", unit::metre, "where the rope ends, in the frame of b").or_else({});
    s.param(wheel_a, "wheel_a", unit::metre, "where the rope to a leaves its wheel, in the world at the present poses");
    s.param(wheel_b, "wheel_b", unit::metre, "where the rope to b leaves its wheel, likewise");
    s.param(ratio, "ratio", unit::one, "parts of the rope that carry b").or_else(1).positive();
    s.param(length, "length", unit::metre, "of the rope: length_a + ratio length_b; infinite: not given, then as it is when it is placed")
        .or_else(kInfinity)
        .not_negative()
        .may_be_infinite();
    s.param(slack, "slack", unit::one, "the rope can go slack: it pulls only, and needs a manager").or_else(false);
    s.param(restitution, "restitution", unit::one, "of a slack rope: fraction of the speed returned when it becomes taut")
        .or_else(0)
        .not_negative()
        .at_most(1);
    s.role(manager, "manager", {Facet::Component}, "solves the row of a rope that can go slack").family("Manager/").optional();
    s.state(placed_wheel_a, "placed_wheel_a", unit::metre, "the parameter from which point_a was taken")
        .initially(kNotGiven)
        .may_be_infinite();
    s.state(placed_wheel_b, "placed_wheel_b", unit::metre, "the parameter from which point_b was taken")
        .initially(kNotGiven)
        .may_be_infinite();
    s.state(point_a, "point_a", unit::metre, "wheel_a in the frame of the carrier, or of the world");
    s.state(point_b, "point_b", unit::metre, "wheel_b in the frame of the carrier, or of the world");
    s.state(placed_length, "placed_length", unit::metre, "of the rope when it was placed");
    s.output(length_a, "length_a", unit::metre, "from wheel_a to a");
    s.output(length_b, "length_b", unit::metre, "from wheel_b to b");
    s.output(tension, "tension", unit::newton,
             "of the rope, at the last solver stage of the step; where it cannot go slack, it pushes below 0");
    s.output(position_error, "position_error", unit::metre, "of the rope's length").reported_as_error();
    s.output(speed_error, "speed_error", unit::metre_per_second, "of its rate").reported_as_error();
    s.output(redundant, "redundant", unit::one, "1: the row is implied by other rows");
}

namespace
{

struct Rope
{
    Stretch a, b;  ///< from the wheels to the bodies
    double length = 0, rate = 0;
};

Rope rope_of(const PulleyRows& rows, Row row, const Bodies& bodies)
{
    const auto part = [&](const Vec3& wheel, Ref body, const Vec3& anchor)
    { return stretch_of(sides_of(side_of(bodies, rows.carrier[row], wheel), side_of(bodies, body, anchor))); };
    Rope rope{part(rows.point_a[row], rows.a[row], rows.anchor_a[row]), part(rows.point_b[row], rows.b[row], rows.anchor_b[row])};
    rope.length = rope.a.distance + rows.ratio[row] * rope.b.distance;
    rope.rate = rope.a.rate + rows.ratio[row] * rope.b.rate;
    return rope;
}

double rest_of(const PulleyRows& rows, Row row) { return rows.length[row] < kInfinity ? rows.length[row] : rows.placed_length[row]; }

}  // namespace

Result<void> prepare_pulley(Row row, PulleyRows& rows, const Bodies& bodies)
{
    if (rows.slack[row] && !rows.manager[row].valid())
        return reason("a rope with slack needs a manager: manager='Manager/Automatic', or the id of one");
    const Side carrier = side_of(bodies, rows.carrier[row], {});
    const auto place = [&](const Vec3& wheel, Vec3& placed, Vec3& point)
    {
        if (placed == wheel) return false;
        placed = wheel, point = rotate(conjugate(carrier.q), wheel - carrier.p);
        return true;
    };
    const bool moved_a = place(rows.wheel_a[row], rows.placed_wheel_a[row], rows.point_a[row]),
               moved_b = place(rows.wheel_b[row], rows.placed_wheel_b[row], rows.point_b[row]);
    if (moved_a || moved_b) rows.placed_length[row] = rope_of(rows, row, bodies).length;
    return {};
}

void constrain_pulley(const StepContext& step, Rows which, const PulleyRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Rope rope = rope_of(rows, row, bodies);
        ConstraintRow out;
        add_row(stretch_row(rope.a, 0, 1, 0), 1, out);
        add_row(stretch_row(rope.b, 0, 1, 0), rows.ratio[row], out);  // last, as the reaction is that on b
        out.error = rope.length - rest_of(rows, row);
        sink.begin(step.component_of_row[row]);
        if (!rows.slack[row])
        {
            sink.add(out);
            continue;
        }
        const double activation = activation_by_size(bodies, std::array{rows.a[row], rows.b[row], rows.carrier[row]});
        add_bound(step, opposite(out), -out.error, -rope.rate, activation, rows.restitution[row], sink);
    }
}

void finish_pulley(const StepContext& step, Rows which, PulleyRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which)
    {
        const Rope rope = rope_of(rows, row, bodies);
        const RowReport report = reports.of(step.component_of_row[row]);
        rows.length_a[row] = rope.a.distance, rows.length_b[row] = rope.b.distance;
        rows.tension[row] = -dot(rope.b.u, report.force) / rows.ratio[row];
        const double longer = rope.length - rest_of(rows, row);
        const bool is_slack = rows.slack[row] && longer < 0;
        rows.position_error[row] = is_slack ? 0 : longer, rows.speed_error[row] = is_slack ? 0 : rope.rate;
        rows.redundant[row] = report.redundant;
    }
}

}  // namespace plab::constraints
