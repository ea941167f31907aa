/// One time step of an island at the velocity level, followed by a position correction. SequentialImpulse and Direct share it.
///
///   impacts     v+ = v0 + M^-1 J^T j        u_n >= e * approach for contacts that begin; persistent ones: see stepping.h
///   kick        v* = v+ + h a
///   contact     v1 = v* + M^-1 J^T j        u_n >= depth / h where a gap is left, else >= 0;   Coulomb's cone
///   move        x1 = x0 + h (v+ + v1) / 2   exact for constant deceleration, and for a parabola between two bounces
///   positions   remaining overlap is corrected by displacements alone, so that it adds neither velocity nor energy
///
/// The order matters. Impacts come first because restitution acts on the velocities at which the bodies met, before the forces
/// of the step have changed them. The forces (the kick) come before the contact impulses because these impulses must also
/// balance the forces: that is what holds a resting body. Positions move with the mean of the velocities before and after, which
/// makes the step of a uniformly decelerated body exact.
///
/// Sources: Moreau (1988) for the impacts (simultaneous, Newton's restitution; elastic impacts without friction conserve the
/// energy); Anitescu, Potra (1997) for the contact impulses; Cline, Pai (2003) for the positions.
#pragma once

#include "stepping.h"

namespace plab::managers
{

Verdict advance_island(Island& island, Bodies& bodies, Shafts& shafts, Method& method, const StepChoices& choices, StepMemory& memory);

}  // namespace plab::managers
