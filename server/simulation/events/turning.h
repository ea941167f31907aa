/// Bounds on how fast the points of a free body can move about its centre of mass.
///
/// Without torque, the angular velocity stays on the intersection of two ellipsoids (Poinsot): with the principal moments of inertia
/// I_k, 2 T = sum I_k w_k^2 and |L|^2 = sum I_k^2 w_k^2 are constant. So with u_k = 1 / I_k and u_1 <= u_2 <= u_3
///
///   |w|^2 <= 2 T (u_1 + u_3) - |L|^2 u_1 u_3,        |w_k| <= min(|L| u_k, sqrt(2 T u_k))
///
/// since |w|^2 = |L|^2 E[u^2] and 2 T = |L|^2 E[u], where E is the mean with the weights L_k^2 / |L|^2, and u^2 lies below its chord
/// between u_1 and u_3. A point at distance a_k from principal axis k has |w x r| <= sum |w_k| a_k: the bound for a rod that spins about
/// its length depends on its thickness only. Euler's equations give |w_k'| <= |I_i - I_j| u_k |w_i w_j|. The effect of torques on L and T
/// is estimated from the difference of L between the two ends of the piece.
#pragma once

#include <array>

#include "plab/tables.h"

namespace plab::simulation
{

/// A body's inertia and size about its principal axes.
struct PrincipalExtent
{
    std::array<double, 3> inertia{};  ///< kg m^2, ascending; 0 if forces do not rotate the body
    std::array<double, 3>
        arm{};  ///< m: largest distance of its points from that axis; the rounding radius of balls and capsules does not count
};
PrincipalExtent principal_extent_of(const Bodies& bodies, const Shapes& shapes, std::uint32_t b);

/// Bounds that hold over one smooth piece.
struct TurningBound
{
    double spin = 0;      ///< rad/s, of the angular speed
    double spin_up = 0;   ///< rad/s^2, of the angular acceleration
    double sweep = 0;     ///< m/s, of the speed of any point about the centre of mass
    double sweep_up = 0;  ///< m/s^2, of the acceleration of any point about the centre of mass
};
/// For a body with constant angular velocity (rad/s, W). `arm`: m, distance of its furthest point from the centre of mass.
TurningBound steady_turning(const Vec3& spin, double arm);
/// For a free body with angular momenta L (kg m^2/s, W) and angular velocities (rad/s, W) at the two ends of a piece of `time` s.
/// `reserve`: safety factor on the mean torque, which follows from the change of the momentum.
TurningBound free_turning(const PrincipalExtent& body, double arm, const std::array<Vec3, 2>& momentum, const std::array<Vec3, 2>& spin,
                          double time, double reserve);

}  // namespace plab::simulation
