#include "joints/universal.h"

#include <cmath>

namespace plab::constraints
{
namespace
{

constexpr double kParallel = 1e-3;  // sine of the angle between the axes

/// rad: by which the cross, whose other axis is `other`, is turned about the axis n from where the joint was placed. `n_B`, `other_B`: both
/// in the frame q of the body in which n is fixed, as they were then.
double turned(const Quat& q, const Vec3& n_B, const Vec3& other_B, const Vec3& other)
{
    const Vec3 n = rotate(q, n_B), start = rotate(q, other_B);
    return std::atan2(dot(n, cross(start, other)), dot(cross(n, start), cross(n, other)));
}

}  // namespace

void UniversalRows::describe(Schema& s)
{
    describe_pair(s);
    s.param(axis, "axis", unit::one, "direction of the axis that is fixed in a, in the world at the present poses")
        .or_else({1, 0, 0})
        .unit_length();
    s.param(axis_b, "axis_b", unit::one, "likewise of the axis that is fixed in b; not parallel to the other one")
        .or_else({0, 1, 0})
        .unit_length();
    s.state(own_a, "axis_in_a", unit::one, "the first axis in the frame of a, or in the world");
    s.state(own_b, "axis_in_b", unit::one, "the second axis in the frame of b");
    s.state(other_a, "cross_in_a", unit::one, "the second axis in the frame of a when the joint was placed");
    s.state(other_b, "cross_in_b", unit::one, "the first axis in the frame of b then");
    s.state(placed_a, "placed_first", unit::one, "the axis parameter from which they were taken").initially({});
    s.state(placed_b, "placed_second", unit::one, "the axis_b parameter from which they were taken").initially({});
    about_a.describe_meter(s, "first_", "rotation of the cross relative to a since the joint was placed");
    about_b.describe_meter(s, "second_", "rotation of b relative to the cross since the joint was placed");
    describe_reaction(s, "b");
}

Result<void> prepare_universal(Row row, UniversalRows& rows, const Bodies& bodies)
{
    rows.place_points(row, bodies);
    const Vec3 &n_a = rows.axis[row], &n_b = rows.axis_b[row];
    if (length(cross(n_a, n_b)) < kParallel)
        return reason("axis and axis_b must not be parallel: the cross of a universal joint has two axes");
    if (rows.placed_a[row] == n_a && rows.placed_b[row] == n_b) return {};
    const Quat q_a = rows.a[row].valid() ? bodies.orientation[rows.a[row].index] : Quat{}, q_b = bodies.orientation[rows.b[row].index];
    rows.own_a[row] = rotate_back(q_a, n_a), rows.own_b[row] = rotate_back(q_b, n_b);
    rows.other_a[row] = rotate_back(q_a, n_b), rows.other_b[row] = rotate_back(q_b, n_a);
    rows.placed_a[row] = n_a, rows.placed_b[row] = n_b;
    rows.about_a.reset(row), rows.about_b.reset(row);
    return {};
}

void constrain_universal(const StepContext& step, Rows which, const UniversalRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        sink.begin(step.component_of_row[row]);
        add_point_rows(s, 0, sink);
        sink.add(angle_row(s, rotate(s.a.q, rows.own_a[row]), rotate(s.b.q, rows.own_b[row]), dot(rows.own_a[row], rows.other_a[row]), 3));
    }
}

void finish_universal(const StepContext& step, Rows which, UniversalRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which)
    {
        const Sides s = rows.sides(row, bodies);
        const Vec3 n_a = rotate(s.a.q, rows.own_a[row]), n_b = rotate(s.b.q, rows.own_b[row]);
        // w_ba = rate_a n_a + rate_b n_b.
        const double c = dot(n_a, n_b), along_a = dot(n_a, s.w_ba), along_b = dot(n_b, s.w_ba), sine = 1 - c * c;
        const double rate_a = (along_a - c * along_b) / sine, rate_b = (along_b - c * along_a) / sine;
        rows.about_a.keep(row, turned(s.a.q, rows.own_a[row], rows.other_a[row], n_b), rate_a, step.time, step.dt);
        rows.about_b.keep(row, -turned(s.b.q, rows.own_b[row], rows.other_b[row], n_a), rate_b, step.time, step.dt);
        rows.take_report(row, reports, step.component_of_row[row]);
    }
}

}  // namespace plab::constraints
