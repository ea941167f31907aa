#include "joints/spin.h"

#include <utility>

namespace plab::constraints
{

void add_spin(const Spin& spin, double factor, ConstraintRow& row)
{
    add_block({spin.base, {}, -factor * spin.n}, row);
    add_block({spin.participant, {}, factor * spin.n}, row);
    row.bias += factor * spin.extra;
}

Coordinate turning(const Spin& spin, double angle)
{
    Coordinate c{angle, spin.speed, {}};
    add_spin(spin, 1, c.row);
    return c;
}

Coordinate sliding(const Sides& s, const Vec3& t)
{
    Coordinate c{0, dot(t, s.rate) + dot(cross(s.a.w, t), s.d), travel_row(s, t, 0, 0)};
    c.x = std::exchange(c.row.error, 0.0);
    return c;
}

void SpinColumns::describe_axle(Schema& s, const std::string& prefix, const std::string& whose)
{
    s.param(axis, prefix + "axis", unit::one, "of a body: axle of " + whose + ", in the world at the present poses")
        .or_else({0, 0, 1})
        .unit_length();
    s.state(frame_a, prefix + "frame_base", unit::one, "the axle's frame (z along it) in the base");
    s.state(frame_b, prefix + "frame", unit::one, "the axle's frame in the body");
    s.state(placed_axis, prefix + "placed_axis", unit::one, "the axis parameter from which the frames were taken").initially({});
}

void SpinColumns::describe_spin(Schema& s, const std::string& prefix, const std::string& whose)
{
    describe_axle(s, prefix, whose);
    describe_meter(s, prefix, "rotation angle of " + whose);
}

Result<void> SpinColumns::place(Row row, Ref participant, Ref base, const Bodies& bodies)
{
    if (base.valid() && base.facet != participant.facet) return reason("a shaft turns against a shaft, and a body against a body");
    if (participant.facet == Facet::Shaft) return {};
    const Quat q_base = base.valid() ? bodies.orientation[base.index] : Quat{};
    if (place_axis(row, q_base, bodies.orientation[participant.index])) reset(row);
    return {};
}

Spin SpinColumns::spin_of(Row row, Ref participant, Ref base, const Bodies& bodies, const Shafts& shafts) const
{
    Spin spin{participant, base, {1, 0, 0}, 0, 0, 0, false};
    if (participant.facet == Facet::Shaft)
    {
        spin.twist = shafts.angle[participant.index] - (base.valid() ? shafts.angle[base.index] : 0.0);
        spin.speed = shafts.speed[participant.index] - (base.valid() ? shafts.speed[base.index] : 0.0);
        return spin;
    }
    const Quat frame = bodies.orientation[participant.index] * frame_b[row];
    const Quat frame_base = (base.valid() ? bodies.orientation[base.index] : Quat{}) * frame_a[row];
    const Vec3 w = bodies.angular_velocity[participant.index];
    const Vec3 w_base = base.valid() ? bodies.angular_velocity[base.index] : Vec3{};
    spin.n = rotate(frame, Vec3{0, 0, 1});
    spin.twist = constraints::twist(frame_base, frame);
    spin.speed = dot(spin.n, w - w_base);
    spin.extra = dot(cross(w, spin.n), w_base);
    spin.wraps = true;
    return spin;
}

}  // namespace plab::constraints
