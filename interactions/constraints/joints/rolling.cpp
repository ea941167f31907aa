#include "joints/rolling.h"

#include "plab/limits.h"

namespace plab::constraints
{
namespace
{

Vec3 times(const Vec3& x, const Vec3& y) { return {x.x * y.x, x.y * y.y, x.z * y.z}; }

/// The point of an ellipsoid that is lowest against the direction m, from its centre, in the frame of its axes.
Vec3 lowest(const Vec3& semi_axes, const Vec3& m)
{
    const Vec3 g = times(times(semi_axes, semi_axes), m);
    return g * (-1 / std::sqrt(dot(m, g)));
}
/// The rate of that point when m changes.
Vec3 lowest_rate(const Vec3& semi_axes, const Vec3& m, const Vec3& m_rate)
{
    const Vec3 squares = times(semi_axes, semi_axes), g = times(squares, m), g_rate = times(squares, m_rate);
    const double h = std::sqrt(dot(m, g));
    return g * (dot(m, g_rate) / (h * h * h)) - g_rate / h;
}

bool on_plane(const RollingRows& rows, Row row) { return rows.on[row] == "plane"; }
bool on_cylinder(const RollingRows& rows, Row row) { return rows.on[row] == "cylinder"; }

/// On entry, c.b.r leads to the centre of the ellipsoid.
void meet_plane(const RollingRows& rows, Row row, const Side& plane, RollingContact& c)
{
    const Mat3 frame = rotation_matrix(plane.q * frame_of_axis(rows.plane_normal[row]));
    c.t1 = {frame(0, 0), frame(1, 0), frame(2, 0)}, c.t2 = {frame(0, 1), frame(1, 1), frame(2, 1)};
    c.n = {frame(0, 2), frame(1, 2), frame(2, 2)}, c.turn = c.a.w;

    const Quat q_F = c.b.q * rows.axes[row];
    const Vec3 w_ba = c.b.w - c.a.w;
    const Vec3 m = rotate_back(q_F, c.n), m_rate = rotate_back(q_F, cross(c.n, w_ba));
    c.b.r += rotate(q_F, lowest(rows.semi_axes[row], m));
    // Subtracts the centres first: far from the origin they agree in most of their digits.
    c.gap = dot(c.n, (c.b.c - c.a.c) + (c.b.r - plane.r));
    c.r_b_rate = cross(c.b.w, c.b.r) + rotate(q_F, lowest_rate(rows.semi_axes[row], m, m_rate));
}

/// The same on a sphere or a cylinder.
void meet_round(const RollingRows& rows, Row row, const Side& round, RollingContact& c)
{
    const double r = rows.semi_axes[row].x, sigma = rows.inside[row] ? -1 : 1;
    Vec3 d = (c.b.c - c.a.c) + (c.b.r - round.r);
    Vec3 d_rate = (c.b.v + cross(c.b.w, c.b.r)) - (round.v + cross(round.w, round.r));
    if (on_cylinder(rows, row))
    {
        c.u = rotate(round.q, rows.plane_normal[row]);
        const Vec3 u_rate = cross(round.w, c.u);
        const double along = dot(d, c.u);
        d_rate = d_rate - (dot(d_rate, c.u) + dot(d, u_rate)) * c.u - along * u_rate;
        d = d - along * c.u;
    }
    const double distance = length(d);
    const Vec3 N = d / distance, n_rate = (sigma / distance) * (d_rate - dot(N, d_rate) * N);
    c.n = sigma * N, c.gap = sigma * (distance - rows.radius[row]) - r;
    // Tangents: along the cylinder, or perpendicular to n and to an axis of W.
    const Vec3 k = std::fabs(c.n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, square = cross(c.n, k), square_rate = cross(n_rate, k);
    c.t1 = on_cylinder(rows, row) ? c.u : normalized(square), c.t2 = cross(c.n, c.t1);
    const Vec3 t1_rate = on_cylinder(rows, row) ? cross(round.w, c.u) : (square_rate - dot(c.t1, square_rate) * c.t1) / length(square);
    c.turn = 0.5 * (cross(c.n, n_rate) + cross(c.t1, t1_rate) + cross(c.t2, cross(n_rate, c.t1) + cross(c.n, t1_rate)));
    c.r_b_rate = cross(c.b.w, c.b.r) - r * n_rate;
    c.b.r -= r * c.n;
}

/// The default `point` of the surface: such that b touches it where `normal` points from the surface to b.
Vec3 point_below(const RollingRows& rows, Row row, const Bodies& bodies)
{
    const Vec3 &s = rows.semi_axes[row], &n = rows.normal[row];
    const Quat q_F = bodies.orientation[rows.b[row].index] * rows.axes[row];
    const Vec3 centre = side_of(bodies, rows.b[row], rows.centre[row]).p;
    if (on_plane(rows, row)) return centre + rotate(q_F, lowest(s, rotate_back(q_F, n)));
    return centre + (rows.inside[row] ? rows.radius[row] - s.x : -(rows.radius[row] + s.x)) * n;
}

Result<void> check_rolling(const RollingRows& rows, Row row)
{
    const Vec3& s = rows.semi_axes[row];
    if (!(s.x > 0 && s.y > 0 && s.z > 0)) return reason("semi_axes must be above 0");
    if (rows.parallel[row] && !on_cylinder(rows, row)) return reason("parallel requires rolling on a cylinder");
    if (on_plane(rows, row)) return {};
    if (!(s.x == s.y && s.y == s.z))
        return reason("on a " + rows.on[row] + " only a ball can roll: semi_axes must be three times its radius");
    if (!(rows.radius[row] > 0)) return reason("on a " + rows.on[row] + " the parameter radius must be above 0");
    if (rows.inside[row] && !(rows.radius[row] > s.x)) return reason("to roll inside, the ball must be smaller than radius");
    return {};
}

}  // namespace

void RollingRows::describe(Schema& s)
{
    s.role(a, "a", {Facet::Body}, "the body with the surface; none: the world").optional().writes();
    s.role(b, "b", {Facet::Body}, "the body that rolls").writes();
    s.param(semi_axes, "semi_axes", unit::metre, "half lengths of the ellipsoid; a ball: three times its radius").at_least(kLeastGiven);
    s.param(centre, "centre", unit::metre, "of the ellipsoid, in the frame of b").or_else({});
    s.param(axes, "axes", unit::one, "attitude of the ellipsoid's axes in b").or_else(Quat{});
    s.param(on, "on", unit::one, "kind of surface of a; on a sphere or a cylinder only a ball can roll")
        .or_else("plane")
        .one_of({"plane", "sphere", "cylinder"});
    s.param(radius, "radius", unit::metre, "of that sphere or cylinder").or_else(0).not_negative();
    s.param(inside, "inside", unit::one, "whether it rolls inside the sphere or cylinder instead of outside").or_else(false);
    s.param(point, "point", unit::metre,
            "a point of the plane, the centre of the sphere, or a point on the axis of the cylinder, in the "
            "world at the present poses; infinite: not given, then placed such that b touches it with `normal`")
        .or_else(kNotGiven)
        .may_be_infinite();
    s.param(normal, "normal", unit::one,
            "from the surface to b where they touch, in the world at the present poses; ignored if the point of "
            "a sphere or cylinder is given")
        .or_else({0, 0, 1})
        .unit_length();
    s.param(axis, "axis", unit::one, "of the cylinder, in the world at the present poses").or_else({0, 1, 0}).unit_length();
    s.param(parallel, "parallel", unit::one, "b is a cylinder that touches along a line: it stays parallel to the cylinder's present axis")
        .or_else(false);
    s.state(plane_point, "plane_point", unit::metre, "the point in the frame of a, or of the world");
    s.state(plane_normal, "plane_normal", unit::one, "the plane's normal there, or the cylinder's axis");
    s.state(placed_axis, "placed_axis", unit::one, "the axis parameter from which it was taken").initially({});
    s.state(axis_b, "axis_b", unit::one, "the cylinder's axis in the frame of b");
    s.state(placed_point, "placed_point", unit::metre, "the point parameter from which it was taken").initially({}).may_be_infinite();
    s.state(placed_normal, "placed_normal", unit::one, "the normal parameter from which it was taken").initially({});
    s.state(placed, "placed", unit::one, "the plane has been taken").initially(false);
    s.output(contact, "contact", unit::metre, "where it touches, in the world");
    s.output(normal_force, "normal_force", unit::newton, "on b along the normal; below 0 a real contact would separate");
    describe_reaction(s, "b");
}

RollingContact contact_of(const RollingRows& rows, Row row, const Bodies& bodies)
{
    RollingContact c;
    const Side surface = side_of(bodies, rows.a[row], rows.plane_point[row]);
    c.a = surface, c.b = side_of(bodies, rows.b[row], rows.centre[row]);
    on_plane(rows, row) ? meet_plane(rows, row, surface, c) : meet_round(rows, row, surface, c);
    c.b.p = c.b.c + c.b.r;
    c.a.r = (c.b.c - c.a.c) + c.b.r, c.a.p = c.b.p;
    c.slip = (c.b.v + cross(c.b.w, c.b.r)) - (c.a.v + cross(c.a.w, c.a.r));
    c.r_a_rate = c.b.v + c.r_b_rate - c.a.v;
    return c;
}

Result<void> prepare_rolling(Row row, RollingRows& rows, const Bodies& bodies)
{
    if (auto makes_sense = check_rolling(rows, row); !makes_sense) return makes_sense;
    const bool known = rows.placed_point[row] == rows.point[row] && rows.placed_normal[row] == rows.normal[row];
    if (rows.placed[row] && known && (!on_cylinder(rows, row) || rows.placed_axis[row] == rows.axis[row])) return {};
    const Pose pose_a = rows.a[row].valid() ? bodies.pose(rows.a[row].index) : Pose{};
    const Vec3 fixed = on_cylinder(rows, row) ? rows.axis[row] : rows.normal[row];
    const Vec3 point = rows.point[row] == kNotGiven ? point_below(rows, row, bodies) : rows.point[row];
    rows.plane_point[row] = inverse(pose_a) * point, rows.plane_normal[row] = rotate_back(pose_a.q, fixed);
    rows.axis_b[row] = rotate_back(bodies.orientation[rows.b[row].index], rows.axis[row]);
    rows.placed_point[row] = rows.point[row], rows.placed_normal[row] = rows.normal[row], rows.placed_axis[row] = rows.axis[row];
    rows.placed[row] = true;
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
            out.bias = -dot(e, turns) - dot(cross(c.turn, e), c.slip);
            sink.add(out);
        }
        if (!rows.parallel[row]) continue;
        const Vec3 t1 = any_perpendicular(rows.plane_normal[row]), t2 = cross(rows.plane_normal[row], t1);
        add_axis_rows(sides_of(c.a, c.b), c.u, rotate(c.b.q, rows.axis_b[row]), rotate(c.a.q, t1), rotate(c.a.q, t2), feature, sink);
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
