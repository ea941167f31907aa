/// What impulses act on: the movers of an island, and its contact points. In the notation of problem.h.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "plab/lanes.h"
#include "plab/ref.h"

namespace plab::managers
{

using namespace lanes;  // NOLINT: the names of this folder's inner loops

/// Room for `count` elements, by powers of two: working memory that serves islands of all sizes soon fits all of them.
template <class T>
void make_room(std::vector<T>& memory, std::size_t count)
{
    if (memory.capacity() < count) memory.reserve(std::bit_ceil(count));
}

/// A line of a cache, bytes.
inline constexpr std::size_t kCacheLine = 64;

/// What the innermost loops need of a body, or of a shaft (which uses w.x alone). Sweeps read and write one line of it, the velocities.
struct alignas(kCacheLine) Mover
{
    PaddedVec3 v;  ///< m/s
    PaddedVec3 w;  ///< rad/s, in W; a shaft: x only
    double inverse_mass = 0;
    bool isotropic = false;  ///< the same inertia in all axes: it does not change when the body turns
    bool turned = false;     ///< has turned so far in the last move, and in those before it, that mobilities are to be computed anew
    Mat3 inverse_inertia;    ///< in W; a shaft: only element (0,0)
};

/// Velocities of a mover.
struct alignas(kCacheLine) MoverSpeeds
{
    PaddedVec3 v;  ///< m/s
    PaddedVec3 w;  ///< rad/s, W
};

/// The remaining data of a mover, kept apart so that the inner loops touch less memory.
struct Anchor
{
    std::uint32_t host = kNoIndex;  ///< row in Bodies or Shafts
    bool shaft = false;
    bool midway = false;  ///< the inertia is that of the middle of the step, and w that of the momentum there
    double mass = 1;
    Mat3 inertia;       ///< W
    Vec3 v, w;          ///< velocities without the impulses of this solve
    Vec3 moved_with;    ///< N m s: Momentum::turn in the last move
    double turned = 0;  ///< rad: bound on how far it has turned since Mover::turned was set last
    Vec3 swings;        ///< rad/s: how its free rotation changes w from the middle to the end of the step
    Quat half_turn;     ///< if midway: how it has turned freely by the middle of the step, in W
    Vec3 written;       ///< N m s: the part of Momentum::turn that has been written to the table already
};

/// J: twice the kinetic energy of a mover with these velocities.
inline double twice_energy(const Anchor& m, const Vec3& v, const Vec3& w) { return m.mass * length_squared(v) + dot(w, m.inertia * w); }

/// The sum of the impulses on a mover.
struct alignas(kCacheLine) Momentum
{
    PaddedVec3 push;  ///< N s
    PaddedVec3 turn;  ///< N m s
};

struct Point
{
    std::uint32_t a = kNoIndex, b = kNoIndex;  ///< movers; kNoIndex: impulses do not move this side
    Vec3 n, t1, t2;                            ///< W
    Vec3 r_a, r_b;                             ///< m, from the centres of mass to the point, in W
    Vec3 given;                                ///< m/s: contribution to u of bodies that are not movers
    Vec3 turning;                              ///< m/s: contribution to u of what corners turn after the middle of the step
    Mat3 K;                                    ///< 1/kg
    double slip_mobility = 0;                  ///< 1/kg, largest eigenvalue of K's tangential part
    double friction = 0;
    double least = 0;  ///< m/s: u_n >= least
    Vec3 impulse;      ///< N s, in contact coordinates

    bool frictional() const { return friction > 0; }
    bool mobile() const { return a != kNoIndex || b != kNoIndex; }
};

}  // namespace plab::managers
