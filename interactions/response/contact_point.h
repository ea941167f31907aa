/// A contact as the responses use it: its axes, its collision matrix K, its velocity, and the effect of impulses on the bodies.
#pragma once

#include "plab/collision.h"
#include "plab/tables.h"

namespace plab::response
{

/// Constant while impulses act, since nothing moves at an instant. Vectors in contact coordinates are (t1, t2, n).
class ContactPoint
{
public:
    ContactPoint() = default;
    ContactPoint(const Contact& contact, const Bodies& bodies);

    /// u = velocity of b's point relative to a's, m/s.
    Vec3 velocity(const Bodies& bodies) const;
    /// Applies j (contact coordinates, N s) to b and -j to a. `normal_velocity` is the u_n that results. If the centres of mass
    /// lie on the normal, the normal velocities are set by
    ///   v_a' = (m_a v_a + m_b (v_b - u_n')) / (m_a + m_b),
    /// which is free of cancellation whatever the masses, and leaves a body at rest exactly at rest.
    void apply(Bodies& bodies, const Vec3& j, double normal_velocity) const;

    const Mat3& K() const { return K_; }  ///< 1/kg, in contact coordinates
    bool moves() const { return inverse_mass_ > 0; }
    Vec3 to_world(const Vec3& v) const { return t1_ * v.x + t2_ * v.y + n_ * v.z; }
    Vec3 to_contact(const Vec3& v_W) const { return {dot(t1_, v_W), dot(t2_, v_W), dot(n_, v_W)}; }

private:
    void add_body(const Bodies& bodies, std::uint32_t body);

    std::uint32_t a_ = 0, b_ = 0;
    Vec3 point_, n_, t1_, t2_;
    Mat3 K_;
    double inverse_mass_ = 0;  // of both, 1/kg
    bool central_ = false;
};

}  // namespace plab::response
