/// One contact point, one instant: the impulse of an impact with friction and restitution.
///
/// Coordinates (t1, t2, n) of the contact; u = relative velocity of b's point to a's (u_n < 0: closing), K = collision
/// matrix, du = K dJ. Sliding, dJ = (-mu s, 1) dJ_n with s the direction of slip (Coulomb, a true cone):
///
///   du/dJ_n = K (-mu s, 1)      until u_n = 0 (compression, work W_c of the normal impulse), then until
///   W = -e^2 W_c is given back  (restitution; Stronge's energetic coefficient).
///
/// Where slip ends, it stays ended if |K_tt^-1 K_tn| <= mu, else it starts again along the one ray that leads away.
/// Energy never grows. Without friction, and while slip does not turn, this is Newton's u_n' = -e u_n.
/// Sources: Mirtich, PhD thesis, UC Berkeley (1996), chapter 3; Stronge, Impact Mechanics (2000), chapter 5.
#pragma once

#include "plab/vector.h"

namespace plab::response
{

struct ImpactResult
{
    Vec3 impulse;   ///< on b, N s
    Vec3 velocity;  ///< u afterwards, m/s
};

/// For u_n < 0. friction >= 0; restitution in [0, 1].
ImpactResult solve_impact(const Mat3& K, const Vec3& u, double friction, double restitution);

}  // namespace plab::response
