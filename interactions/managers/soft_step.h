/// Soft Step: sub-steps with soft contacts.
///
/// Per sub-step of length h = step / n:
///
///   kick    v <- v + h a
///   solve   j_n <- max(0, j_n - m_eff mass_scale (u_n + bias) - impulse_scale j_n)     a spring and damper, integrated implicitly
///   move    x <- x + h v
///   relax   the same without bias: removes the velocity that the position correction has added
///
/// with omega = 2 pi hertz, zeta the damping ratio, c = h omega (2 zeta + h omega):
///   bias = omega / (2 zeta + h omega) * overlap (limited to push_speed),  mass_scale = c / (1 + c),
///   impulse_scale = 1 / (1 + c).   Contacts with a gap: bias = gap / h, and they are hard.
///
/// Why it is robust: many short sub-steps with one sweep each converge better than one long step with many sweeps, and a soft
/// contact limits how fast overlap is pushed out. The price is that contacts yield under load, as springs do.
///
/// Bodies turn freely in a move, which conserves their energy; K is then recomputed for the new attitude. If the velocities left
/// over from the position correction have raised the kinetic energy, hard sweeps follow. If these do not remove the gain, the
/// sub-step is repeated without position correction: sweeps from zero impulses, which only remove energy, and then the move.
///
/// Restitution is applied once, after the last sub-step, to each contact or limit that carried an impulse and was met faster
/// than it now separates. The amount is limited to the energy at the start of the step plus the work of the forces on the way.
/// Joints take part in the impulses that limits return.
/// Source: Catto, Solver2D (2024), "Soft Step" (solve_soft_step.c); Macklin et al., Small Steps (2019), for sub-steps.
#pragma once

#include "soft_island.h"

namespace plab::managers
{

Verdict advance_softly(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory);

}  // namespace plab::managers
