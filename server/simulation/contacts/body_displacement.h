/// A small displacement of a body that leaves its velocities unchanged; used to remove overlap.
#pragma once

#include "plab/body_turn.h"
#include "plab/rotation.h"
#include "plab/tables.h"

namespace plab::simulation
{

/// Accumulates positional impulses (kg m, in some direction at some point); apply() moves the body.
struct BodyDisplacement
{
    Vec3 arm_origin;  ///< p_WC
    Mat3 inverse_inertia_W;
    double inverse_mass = 0;
    Vec3 shift;  ///< m
    Vec3 turn;   ///< rad

    BodyDisplacement(const Bodies& bodies, std::uint32_t b) : arm_origin(bodies.position[b])
    {
        if (!bodies.dynamic(b)) return;
        inverse_mass = bodies.inverse_mass[b];
        inverse_inertia_W = bodies.inverse_inertia_W(b);
    }
    Vec3 at(const Vec3& p) const { return shift + cross(turn, p - arm_origin); }
    double mobility(const Vec3& p, const Vec3& n) const
    {
        const Vec3 c = cross(p - arm_origin, n);
        return inverse_mass + dot(c, inverse_inertia_W * c);
    }
    void push(const Vec3& p, const Vec3& impulse)
    {
        shift += impulse * inverse_mass;
        turn += inverse_inertia_W * cross(p - arm_origin, impulse);
    }
    void apply(Bodies& bodies, std::uint32_t b) const
    {
        if (!bodies.dynamic(b)) return;
        bodies.position[b] += shift;
        turn_without_work(bodies, b, exp_rotation(turn));
    }
};

}  // namespace plab::simulation
