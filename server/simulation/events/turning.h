/// How fast the points of a free body can turn about its centre of mass.
///
/// Free of torque, the angular velocity stays on the intersection of two ellipsoids (Poinsot): with the principal inertias I_k,
/// 2 T = sum I_k w_k^2 and |L|^2 = sum I_k^2 w_k^2 do not change. So with u_k = 1 / I_k and u_1 <= u_2 <= u_3
///
///   |w|^2 <= 2 T (u_1 + u_3) - |L|^2 u_1 u_3,        |w_k| <= min(|L| u_k, sqrt(2 T u_k))
///
/// since |w|^2 = |L|^2 E[u^2], 2 T = |L|^2 E[u] with weights L_k^2 / |L|^2, and u^2 lies below its chord. A point at distance
/// a_k from principal axis k has |w x r| <= sum |w_k| a_k: a rod that spins about its length sweeps its thickness only.
/// Euler's equations give |w_k'| <= |I_i - I_j| u_k |w_i w_j|. Torques change L and T by what they are seen to do to L at the ends.
#pragma once

#include <array>

#include "plab/tables.h"

namespace plab::simulation
{

/// A body's inertia and size about its principal axes.
struct PrincipalExtent
{
    std::array<double, 3> inertia{};  ///< kg m^2, ascending; 0 where the body does not turn by forces
    std::array<double, 3> arm{};      ///< m: its points are no further from that axis; the radius around balls and capsules does not count
};
PrincipalExtent principal_extent_of(const Bodies& bodies, const Shapes& shapes, std::uint32_t b);

/// Over one smooth piece.
struct TurningBound
{
    double spin = 0;      ///< rad/s, most
    double spin_up = 0;   ///< rad/s^2, most
    double sweep = 0;     ///< m/s, most of a point about the centre of mass
    double sweep_up = 0;  ///< m/s^2, most of a point about the centre of mass
};
/// Of a body whose spin does not change. `arm`: m, of its furthest point.
TurningBound steady_turning(const Vec3& spin, double arm);
/// Of a free body with angular momenta L (kg m^2/s, W) and spins (rad/s, W) at the two ends of a piece of `time` s. `reserve`: how many
/// times the torque that the change of momentum shows may act.
TurningBound free_turning(const PrincipalExtent& body, double arm, const std::array<Vec3, 2>& momentum, const std::array<Vec3, 2>& spin,
                          double time, double reserve);

}  // namespace plab::simulation
