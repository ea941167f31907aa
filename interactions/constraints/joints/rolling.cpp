#include "joints/rolling.h"

namespace plab::constraints
{
namespace
{

Vec3 times(const Vec3& x, const Vec3& y) { return {x.x * y.x, x.y * y.y, x.z * y.z}; }

/// The lowest point of an ellipsoid against the direction m, from its centre, in the frame of its axes.
Vec3 lowest(const Vec3& semi_axes, const Vec3& m)
{
    const Vec3 g = times(times(semi_axes, semi_axes), m);
    return g * (-1 / std::sqrt(dot(m, g)));
}
/// How fast it moves there when m does.
Vec3 lowest_rate(const Vec3& semi_axes, const Vec3& m, const Vec3& m_rate)
{
    const Vec3 squares = times(semi_axes, semi_axes), g = times(squares, m), g_rate = times(squares, m_rate);
    const double h = std::sqrt(dot(m, g));
    return g * (dot(m, g_rate) / (h * h * h)) - g_rate / h;
}

}  // namespace

void RollingRows::describe(Schema& s)
{
    s.role(a, "a", {Facet::Body}, "whose plane it is; none: the world").optional().writes();
    s.role(b, "b", {Facet::Body}, "who rolls").writes();
    s.param(semi_axes, "semi_axes", unit::metre, "half lengths of the ellipsoid; a ball: three times its radius");
    s.param(centre, "centre", unit::metre, "of the ellipsoid, in the frame of b").or_else({});
    s.param(axes, "axes", unit::one, "attitude of the ellipsoid's axes in b").or_else(Quat{});
    s.param(point, "point", unit::metre,
            "of the plane, in the world as things are now; infinite: not given, then where the ellipsoid is lowest")
        .or_else(kNotGiven)
        .may_be_infinite();
    s.param(normal, "normal", unit::one, "of the plane, to the side of b, in the world as it is now").or_else({0, 0, 1}).unit_length();
    s.state(plane_point, "plane_point", unit::metre, "a point of the plane in the frame of a, or of the world");
    s.state(plane_normal, "plane_normal", unit::one, "its normal there");
    s.state(placed_point, "placed_point", unit::metre, "the point that it was taken from").initially({}).may_be_infinite();
    s.state(placed_normal, "placed_normal", unit::one, "the normal that it was taken from").initially({});
    s.state(placed, "placed", unit::one, "the plane has been taken").initially(false);
    s.output(contact, "contact", unit::metre, "where it touches, in the world");
    s.output(normal_force, "normal_force", unit::newton, "on b along the normal; below 0 a real plane would let go");
    describe_reaction(s, "b");
}

RollingContact contact_of(const RollingRows& rows, Row row, const Bodies& bodies)
{
    RollingContact c;
    const Side plane = side_of(bodies, rows.a[row], rows.plane_point[row]);
    c.a = plane, c.b = side_of(bodies, rows.b[row], rows.centre[row]);
    const Mat3 frame = rotation_matrix(plane.q * frame_of_axis(rows.plane_normal[row]));
    c.t1 = {frame(0, 0), frame(1, 0), frame(2, 0)}, c.t2 = {frame(0, 1), frame(1, 1), frame(2, 1)};
    c.n = {frame(0, 2), frame(1, 2), frame(2, 2)};

    const Quat q_F = c.b.q * rows.axes[row];
    const Vec3 w_ba = c.b.w - c.a.w;
    const Vec3 m = rotate_back(q_F, c.n), m_rate = rotate_back(q_F, cross(c.n, w_ba));
    c.b.r += rotate(q_F, lowest(rows.semi_axes[row], m));
    c.b.p = c.b.c + c.b.r;
    // Centres first: far from the origin they agree in most of their digits.
    const Vec3 apart = c.b.c - c.a.c;
    c.gap = dot(c.n, apart + (c.b.r - plane.r));
    c.a.r = apart + c.b.r, c.a.p = c.b.p;
    c.slip = (c.b.v + cross(c.b.w, c.b.r)) - (c.a.v + cross(c.a.w, c.a.r));
    c.r_b_rate = cross(c.b.w, c.b.r) + rotate(q_F, lowest_rate(rows.semi_axes[row], m, m_rate));
    c.r_a_rate = c.b.v + c.r_b_rate - c.a.v;
    return c;
}

Result<void> prepare_rolling(Row row, RollingRows& rows, const Bodies& bodies)
{
    const Vec3& s = rows.semi_axes[row];
    if (!(s.x > 0 && s.y > 0 && s.z > 0)) return reason("semi_axes must be above 0");
    if (rows.placed[row] && rows.placed_point[row] == rows.point[row] && rows.placed_normal[row] == rows.normal[row]) return {};
    const Pose pose_a = rows.a[row].valid() ? bodies.pose(rows.a[row].index) : Pose{};
    const Vec3& n = rows.normal[row];
    Vec3 on_plane = rows.point[row];
    if (on_plane == kNotGiven)
    {
        const Quat q_F = bodies.orientation[rows.b[row].index] * rows.axes[row];
        on_plane = side_of(bodies, rows.b[row], rows.centre[row]).p + rotate(q_F, lowest(s, rotate_back(q_F, n)));
    }
    rows.plane_point[row] = inverse(pose_a) * on_plane, rows.plane_normal[row] = rotate_back(pose_a.q, n);
    rows.placed_point[row] = rows.point[row], rows.placed_normal[row] = n, rows.placed[row] = true;
    return {};
}

void constrain_rolling(const StepContext& step, Rows which, const RollingRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const RollingContact c = contact_of(rows, row, bodies);
        const Sides sides{c.a, c.b, {}, {}, {}};
        const Vec3 turns = cross(c.b.w, c.r_b_rate) - cross(c.a.w, c.r_a_rate);
        sink.begin(step.component_of_row[row]);
        std::uint32_t feature = 0;
        for (const Vec3& e : {c.n, c.t1, c.t2})
        {
            ConstraintRow out = row_over(sides, e, -cross(c.a.r, e), cross(c.b.r, e), feature);
            out.kind = feature == 0 ? RowKind::Equality : RowKind::Rate;
            if (feature++ == 0) out.error = c.gap;
            out.bias = -dot(e, turns) - dot(cross(c.a.w, e), c.slip);
            sink.add(out);
        }
    }
}

void finish_rolling(const StepContext& step, Rows which, RollingRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which)
    {
        const RollingContact c = contact_of(rows, row, bodies);
        rows.contact[row] = c.b.p;
        rows.normal_force[row] = dot(c.n, rows.take_report(row, reports, step.component_of_row[row]).force);
    }
}

}  // namespace plab::constraints
