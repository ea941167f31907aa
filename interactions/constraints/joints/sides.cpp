#include "joints/sides.h"

namespace plab::constraints
{

Side side_of(const Bodies& bodies, Ref body, const Vec3& point_B)
{
    if (!body.valid()) return {body, {}, {}, {}, {}, point_B, point_B};
    const std::uint32_t i = body.index;
    const Vec3 r = rotate(bodies.orientation[i], point_B - bodies.center_B[i]);
    return {body, bodies.position[i], bodies.velocity[i], bodies.angular_velocity[i], bodies.orientation[i], r, bodies.position[i] + r};
}

Sides sides_of(const Side& a, const Side& b)
{
    // Subtracts the centres first: far from the origin they agree in most of their digits.
    const Vec3 d = (b.c - a.c) + (b.r - a.r);
    return {a, b, d, (b.v + cross(b.w, b.r)) - (a.v + cross(a.w, a.r)), b.w - a.w};
}

ConstraintRow row_over(const Sides& s, const Vec3& linear, const Vec3& angular_a, const Vec3& angular_b, std::uint32_t feature)
{
    ConstraintRow row;
    if (s.a.body.valid()) row.blocks[row.count++] = {s.a.body, -linear, angular_a};
    row.blocks[row.count++] = {s.b.body, linear, angular_b};
    row.feature = feature;
    return row;
}

void add_block(const RowBlock& block, ConstraintRow& row)
{
    if (!block.participant.valid()) return;
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        RowBlock& own = row.blocks[k];
        if (own.participant != block.participant) continue;
        own.linear += block.linear, own.angular += block.angular;
        return;
    }
    row.blocks[row.count++] = block;
}

void add_row(const ConstraintRow& other, double factor, ConstraintRow& row)
{
    for (std::uint32_t k = 0; k < other.count; ++k)
    {
        const RowBlock& block = other.blocks[k];
        add_block({block.participant, block.linear * factor, block.angular * factor}, row);
    }
    row.error += factor * other.error, row.bias += factor * other.bias;
}

void add_point_rows(const Sides& s, std::uint32_t feature, RowSink& sink)
{
    const Vec3 pull = s.centripetal();
    for (int i = 0; i < 3; ++i)
    {
        Vec3 e;
        e[i] = 1;
        ConstraintRow row = row_over(s, e, -cross(s.a.r, e), cross(s.b.r, e), feature + static_cast<std::uint32_t>(i));
        row.error = s.d[i], row.bias = -pull[i];
        sink.add(row);
    }
}

ConstraintRow travel_row(const Sides& s, const Vec3& t, double travel, std::uint32_t feature)
{
    const Vec3 t_rate = cross(s.a.w, t);
    ConstraintRow row = row_over(s, t, -cross(s.a.r + s.d, t), cross(s.b.r, t), feature);
    row.error = dot(t, s.d) - travel;
    row.bias = -dot(t, s.centripetal()) - dot(cross(s.a.w, t_rate), s.d) - 2 * dot(t_rate, s.rate);
    return row;
}

ConstraintRow turn_row(const Sides& s, const Vec3& e, double turned, bool e_turns, std::uint32_t feature)
{
    ConstraintRow row = row_over(s, {}, -e, e, feature);
    row.error = turned;
    if (e_turns) row.bias = -dot(cross(s.a.w, e), s.w_ba);
    return row;
}

void add_attitude_rows(const Sides& s, const Quat& frame_a, const Quat& frame_b, std::uint32_t feature, RowSink& sink)
{
    const Vec3 turned = log_rotation(frame_b * conjugate(frame_a));
    for (int i = 0; i < 3; ++i)
    {
        Vec3 e;
        e[i] = 1;
        sink.add(turn_row(s, e, turned[i], false, feature + static_cast<std::uint32_t>(i)));
    }
}

void add_axis_rows(const Sides& s, const Vec3& n_a, const Vec3& n_b, const Vec3& t1, const Vec3& t2, std::uint32_t feature, RowSink& sink)
{
    const Vec3 c = cross(n_a, n_b);
    const double sine = length(c), cosine = dot(n_a, n_b);
    // The rotation vector that takes n_a to n_b. If they are opposite, any direction perpendicular to n_a will do.
    Vec3 turned = c;
    if (sine > 1e-8)
        turned = c * (std::atan2(sine, cosine) / sine);
    else if (cosine < 0)
        turned = t1 * std::acos(-1.0);
    sink.add(turn_row(s, t1, dot(t1, turned), true, feature));
    sink.add(turn_row(s, t2, dot(t2, turned), true, feature + 1));
}

ConstraintRow angle_row(const Sides& s, const Vec3& e_a, const Vec3& e_b, double cosine, std::uint32_t feature)
{
    const Vec3 k = cross(e_b, e_a), k_rate = cross(cross(s.b.w, e_b), e_a) + cross(e_b, cross(s.a.w, e_a));
    ConstraintRow row = row_over(s, {}, -k, k, feature);
    row.error = dot(e_a, e_b) - cosine;
    row.bias = -dot(k_rate, s.w_ba);
    return row;
}

Axes axes_of(const Quat& q_WF)
{
    const Mat3 R = rotation_matrix(q_WF);
    return {q_WF, {R(0, 0), R(1, 0), R(2, 0)}, {R(0, 1), R(1, 1), R(2, 1)}, {R(0, 2), R(1, 2), R(2, 2)}};
}

Quat frame_of_axis(const Vec3& n)
{
    // The direction half way between z and n.
    if (n.z < -0.999999) return normalized(Quat{-n.y, 1 - n.z, 0, n.x});
    return normalized(Quat{1 + n.z, -n.y, n.x, 0});
}

double twist(const Quat& frame_a, const Quat& frame_b)
{
    const Quat q = conjugate(frame_a) * frame_b;
    const double sign = q.w < 0 ? -1.0 : 1.0;
    return 2 * std::atan2(sign * q.z, sign * q.w);
}

double unwrapped(double angle, double expected)
{
    constexpr double kTurn = 6.283185307179586476925286766559;
    return angle + kTurn * std::round((expected - angle) / kTurn);
}

}  // namespace plab::constraints
