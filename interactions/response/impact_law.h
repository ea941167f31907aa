/// The impact law: the impulse at one contact point, with friction and restitution.
///
/// Contact coordinates (t1, t2, n); u = velocity of b's point relative to a's (u_n < 0: closing), K = collision matrix, du = K
/// dJ. An impact is treated as infinitely short, so positions, and with them K, are constant. Friction may change its direction
/// during the impact because the slip does. The impulse is therefore built up gradually, with the normal impulse J_n in the role
/// of time. While the point slides in the direction s, Coulomb's law (a true cone) gives dJ = (-mu s, 1) dJ_n, and so
///
///   du/dJ_n = K (-mu s, 1)
///
/// Compression lasts until u_n = 0; the normal impulse then has done the work W_c < 0. Restitution lasts until the normal
/// impulse has returned the work e^2 |W_c|. This is Stronge's energetic coefficient of restitution. Unlike Newton's ratio of
/// velocities it can never add energy, even if friction reverses the slip.
///
/// If the slip ends during the impact, the point sticks for the rest of it if friction suffices, |K_tt^-1 K_tn| <= mu. Otherwise
/// it starts to slide again along the one direction that then remains constant. Without friction, or while the slip keeps its
/// direction, the law is Newton's u_n' = -e u_n.
/// Sources: Mirtich, PhD thesis, UC Berkeley (1996), chapter 3; Stronge, Impact Mechanics (2000), chapter 5.
#pragma once

#include "plab/vector.h"

namespace plab::response
{

struct ImpactResult
{
    Vec3 impulse;    ///< on b, N s
    Vec3 velocity;   ///< u afterwards, m/s
    int series = 0;  ///< power series that the path of the slip has taken (slip_path.h)
};

/// Requires u_n < 0, friction >= 0 and restitution in [0, 1].
ImpactResult solve_impact(const Mat3& K, const Vec3& u, double friction, double restitution);

}  // namespace plab::response
