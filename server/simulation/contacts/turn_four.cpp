#include "simulation/contacts/turn_four.h"

#include <algorithm>

#include "plab/free_rotation.h"
#include "plab/lanes.h"
#include "plab/symmetric.h"

namespace plab::simulation
{
namespace
{
namespace four_lanes  // so that the names of lanes stay in this file
{

using namespace lanes;
using Four = std::array<std::uint32_t, 4>;

PLAB_INLINE LaneVec<4> vectors_of(const std::vector<Vec3>& all, const Four& b)
{
    const Vec3 &v0 = all[b[0]], &v1 = all[b[1]], &v2 = all[b[2]], &v3 = all[b[3]];
    return {Lanes<4>{v0.x, v1.x, v2.x, v3.x}, Lanes<4>{v0.y, v1.y, v2.y, v3.y}, Lanes<4>{v0.z, v1.z, v2.z, v3.z}};
}

PLAB_INLINE LaneQuat orientations_of(const Bodies& bodies, const Four& b)
{
    LaneQuat q{load(&bodies.orientation[b[0]].w), load(&bodies.orientation[b[1]].w), load(&bodies.orientation[b[2]].w),
               load(&bodies.orientation[b[3]].w)};
    transpose(q.w, q.x, q.y, q.z);
    return q;
}

PLAB_INLINE LaneMat inverse_inertias_of(const Bodies& bodies, const Four& b)
{
    const double *m0 = bodies.inverse_inertia_B[b[0]].m[0], *m1 = bodies.inverse_inertia_B[b[1]].m[0],
                 *m2 = bodies.inverse_inertia_B[b[2]].m[0], *m3 = bodies.inverse_inertia_B[b[3]].m[0];
    Lanes<4> first[4] = {load(m0), load(m1), load(m2), load(m3)}, second[4] = {load(m0 + 4), load(m1 + 4), load(m2 + 4), load(m3 + 4)};
    transpose(first[0], first[1], first[2], first[3]);
    transpose(second[0], second[1], second[2], second[3]);
    return {
        {{first[0], first[1], first[2]}, {first[3], second[0], second[1]}, {second[2], second[3], Lanes<4>{m0[8], m1[8], m2[8], m3[8]}}}};
}

/// exp_rotation() of a rotation vector with the square t2 < 0.25.
PLAB_INLINE LaneQuat short_rotation(const LaneVec<4>& u, const Lanes<4>& t2)
{
    const Lanes<4> a = 0.25 * t2;
    const Lanes<4> c = 1.0 - a / 2.0 * (1.0 - a / 12.0 * (1.0 - a / 30.0 * (1.0 - a / 56.0 * (1.0 - a / 90.0))));
    const Lanes<4> s = 0.5 * (1.0 - a / 6.0 * (1.0 - a / 20.0 * (1.0 - a / 42.0 * (1.0 - a / 72.0 * (1.0 - a / 110.0)))));
    return {c, s * u.x, s * u.y, s * u.z};
}

PLAB_INLINE LaneVec<4> times(double s, const LaneVec<4>& v) { return {s * v.x, s * v.y, s * v.z}; }

/// The rotation vector of slow_turn().
PLAB_INLINE LaneVec<4> slow_rotation(const LaneMat& inverse_inertia, const LaneVec<4>& m, double t)
{
    const LaneVec<4> w0 = inverse_inertia * m, m1 = cross(m, w0);
    const LaneVec<4> w1 = inverse_inertia * m1, m2 = cross(m1, w0) + cross(m, w1);
    const LaneVec<4> w2 = inverse_inertia * m2, m3 = cross(m2, w0) + times(2, cross(m1, w1)) + cross(m, w2);
    const LaneVec<4> w3 = inverse_inertia * m3;
    const LaneVec<4> third = w2 + times(0.5, cross(w0, w1)), fourth = w3 + cross(w0, w2);
    return times(t, w0 + times(0.5 * t, w1 + times(t / 3, third + times(0.25 * t, fourth))));
}

/// Writes orientations and spins, but for bodies without angular momentum, which keep theirs.
PLAB_INLINE void write_turned(Bodies& bodies, const Four& which, const LaneQuat& q, const LaneMat& inverse_inertia,
                              const LaneVec<4>& momentum)
{
    const LaneMat R = rotation_matrix(q);
    const LaneVec<4> w = R * (inverse_inertia * transposed_times(R, momentum));
    for (int l = 0; l < 4; ++l)
    {
        const std::uint32_t b = which[static_cast<std::size_t>(l)];
        if (lane(momentum, l) == Vec3{}) continue;
        bodies.orientation[b] = {q.w[l], q.x[l], q.y[l], q.z[l]};
        bodies.angular_velocity[b] = lane(w, l);
    }
}

PLAB_INLINE bool all_of(const Lanes<4>& x, double below)
{
    const auto holds = x < below;
    return (holds[0] & holds[1] & holds[2] & holds[3]) != 0;
}

/// Bodies with one moment of inertia each.
PLAB_INLINE bool turn_isotropic(Bodies& bodies, const Four& which, double h)
{
    const LaneVec<4> momentum = vectors_of(bodies.angular_momentum, which);
    const LaneMat inverse_inertia = inverse_inertias_of(bodies, which);
    const LaneVec<4> turn = scaled(momentum, inverse_inertia.row[0].x * h);
    const Lanes<4> t2 = dot(turn, turn);
    if (!all_of(t2, 0.25)) return false;
    const LaneQuat q = normalized(short_rotation(turn, t2) * orientations_of(bodies, which));
    write_turned(bodies, which, q, inverse_inertia, momentum);
    return true;
}

PLAB_INLINE bool turn_slow(Bodies& bodies, const Four& which, double h)
{
    const LaneVec<4> momentum = vectors_of(bodies.angular_momentum, which);
    const LaneMat inverse_inertia = inverse_inertias_of(bodies, which);
    const LaneQuat start = orientations_of(bodies, which);
    const LaneVec<4> momentum_B = rotate_back(start, momentum);
    const Lanes<4> bound = (inverse_inertia.row[0].x + inverse_inertia.row[1].y + inverse_inertia.row[2].z) * h;
    // As turns_slowly(): at most 2^-22.
    const auto slow = dot(momentum_B, momentum_B) * (bound * bound) <= 0x1p-22;
    if ((slow[0] & slow[1] & slow[2] & slow[3]) == 0) return false;
    const LaneVec<4> turn = slow_rotation(inverse_inertia, momentum_B, h);
    const LaneQuat q = normalized(start * short_rotation(turn, dot(turn, turn)));
    write_turned(bodies, which, q, inverse_inertia, momentum);
    return true;
}

}  // namespace four_lanes
}  // namespace

bool turn_four(Bodies& bodies, const std::array<std::uint32_t, 4>& which, double h)
{
    int isotropic = 0;
    for (const std::uint32_t b : which)
    {
        if (bodies.needle[b] != 0) return false;
        isotropic += is_isotropic(bodies.inverse_inertia_B[b]) ? 1 : 0;
    }
    bool done = false;
    if (isotropic == 4) lanes::run_lanes<4>(PLAB_LANES { done = four_lanes::turn_isotropic(bodies, which, h); });
    if (isotropic == 0) lanes::run_lanes<4>(PLAB_LANES { done = four_lanes::turn_slow(bodies, which, h); });
    return done;
}

}  // namespace plab::simulation
