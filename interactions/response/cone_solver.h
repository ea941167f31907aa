/// Several contacts at once: impulses inside friction cones that leave no contact closing.
///
///   u_n >= b,  j_n >= 0,  j_n (u_n - b) = 0,   |j_t| <= mu j_n,   j_t against the slip where |j_t| = mu j_n
///
/// by block Gauss-Seidel: contact after contact in the order of ids, each solved exactly with the others held.
/// Sources: Moreau, Unilateral contact and dry friction (1988); Jourdan, Alart, Jean, CMAME 155 (1998) for the blocks.
#pragma once

#include <span>
#include <vector>

#include "contact_point.h"
#include "plab/interruption.h"

namespace plab::response
{

struct ConeContact
{
    const ContactPoint* point = nullptr;
    double friction = 0;
    double least = 0;  ///< b: smallest u_n that is allowed afterwards, m/s
    Vec3 impulse;      ///< j, N s in contact coordinates; on entry the guess that has been applied already
};

struct ConeResult
{
    int sweeps = 0;
    bool converged = false;
    double residual = 0;  ///< m/s, largest b - u_n left
};

/// The impulse of one contact whose velocity without it is r (m/s). `last`: its impulse in the last sweep, near which it is
/// looked for where repeating does not settle.
Vec3 solve_cone(const Mat3& K, const Vec3& r, double least, double friction, const Vec3& last = {});

/// Changes the velocities in `bodies`. Ends when no impulse changes its contact's velocity by more than `tolerance`
/// (m/s), or when the step is given up.
ConeResult solve_cones(std::span<ConeContact> contacts, Bodies& bodies, double tolerance, int max_sweeps,
                       const Interruption* interruption = nullptr);

}  // namespace plab::response
