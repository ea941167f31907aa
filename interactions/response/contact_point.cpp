#include "contact_point.h"

#include "plab/contact_mobility.h"

namespace plab::response
{

ContactPoint::ContactPoint(const Contact& contact, const Bodies& bodies)
    : a_(contact.a.index), b_(contact.b.index), point_(contact.point), n_(contact.normal)
{
    t1_ = any_perpendicular(n_);
    t2_ = cross(n_, t1_);
    add_body(bodies, a_);
    add_body(bodies, b_);
    const double turning = K_(2, 2);
    for (int i = 0; i < 3; ++i) K_(i, i) += inverse_mass_;
    // `turning` is the square of the rounding error of r x n, so it stays far below this threshold for central contacts.
    central_ = turning <= 1e-20 * inverse_mass_;
}

/// The masses are added last, so that the rotational part is known separately.
void ContactPoint::add_body(const Bodies& bodies, std::uint32_t body)
{
    if (!bodies.dynamic(body)) return;
    inverse_mass_ += bodies.inverse_mass[body];
    add_turning_mobility(K_, bodies.inverse_inertia_W(body), point_ - bodies.position[body], t1_, t2_, n_);
}

Vec3 ContactPoint::velocity(const Bodies& bodies) const
{
    return to_contact(bodies.velocity_at(b_, point_) - bodies.velocity_at(a_, point_));
}

void ContactPoint::apply(Bodies& bodies, const Vec3& j, double normal_velocity) const
{
    // The normal of a central contact meets the centre of a dynamic body; a kinematic one may turn.
    const auto normal_speed = [&](std::uint32_t body)
    { return dot(n_, bodies.dynamic(body) ? bodies.velocity[body] : bodies.velocity_at(body, point_)); };
    const double v_a = normal_speed(a_), v_b = normal_speed(b_);
    const Vec3 j_W = to_world(j);
    bodies.apply_impulse(a_, -j_W, point_);
    bodies.apply_impulse(b_, j_W, point_);
    if (!central_) return;
    const auto set_normal = [&](std::uint32_t body, double v)
    {
        if (!bodies.dynamic(body)) return;
        Vec3& velocity = bodies.velocity[body];
        velocity = (velocity - n_ * dot(n_, velocity)) + n_ * v;
    };
    const double of_a = bodies.inverse_mass[a_] / inverse_mass_, of_b = bodies.inverse_mass[b_] / inverse_mass_;
    set_normal(a_, of_b * v_a + of_a * (v_b - normal_velocity));
    set_normal(b_, of_a * v_b + of_b * (v_a + normal_velocity));
}

}  // namespace plab::response
