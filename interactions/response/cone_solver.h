/// Several contacts at once: impulses inside the friction cones after which no contact closes.
///
///   u_n >= b,  j_n >= 0,  j_n (u_n - b) = 0,   |j_t| <= mu j_n,   j_t opposes the slip where |j_t| = mu j_n
///
/// Solved by block Gauss-Seidel: the contacts are visited in the order of their ids, and each 3 x 3 block is solved exactly
/// while all other impulses are held fixed.
/// Sources: Moreau, Unilateral contact and dry friction (1988); Jourdan, Alart, Jean, CMAME 155 (1998) for the blocks.
#pragma once

#include <span>
#include <vector>

#include "contact_velocities.h"
#include "plab/interruption.h"

namespace plab::response
{

struct ConeContact
{
    std::uint32_t contact = 0;
    double friction = 0;
    double least = 0;  ///< b: smallest u_n that is allowed afterwards, m/s
    Vec3 impulse;      ///< j, N s in contact coordinates; on entry the initial guess, which has been applied already
};

struct ConeResult
{
    int sweeps = 0;
    bool converged = false;
    double residual = 0;  ///< m/s, largest b - u_n left
};

/// The impulse of one contact whose velocity without it is r (m/s). `last` is its impulse in the last sweep: a sliding direction
/// near that of `last` is searched for if the fixed-point iteration does not converge.
Vec3 solve_cone(const Mat3& K, const Vec3& r, double least, double friction, const Vec3& last = {});

/// Changes the velocities. Ends when no impulse changes the velocity of its contact by more than `tolerance` (m/s),
/// or when the step is interrupted.
ConeResult solve_cones(std::span<ConeContact> contacts, ContactVelocities& velocities, double tolerance, int max_sweeps,
                       const Interruption* interruption = nullptr);

/// For impulses that gain energy although nothing bounces. Where bodies wedge, friction may press harder in each sweep, without end. Finds
/// the impulses without friction, which gain none, as a sweep is a projection then, and goes from these as far towards the given ones as no
/// energy is gained: contacts and Coulomb's law hold in between, too. `velocities` are those with the given impulses; `before`: u without
/// them.
ConeResult reduce_friction(std::span<ConeContact> contacts, std::span<const Vec3> before, ContactVelocities& velocities, double tolerance,
                           int max_sweeps, const Interruption* interruption = nullptr);

/// J: the energy that the impulses have added beyond rounding, the sum of j . (u + u') / 2. `before`: u of each contact without them.
double energy_gained(std::span<const ConeContact> contacts, std::span<const Vec3> before, const ContactVelocities& velocities);

}  // namespace plab::response
