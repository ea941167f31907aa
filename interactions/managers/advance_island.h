/// One step of an island by speeds first, positions after: what SequentialImpulse and Direct share.
///
///   impacts     v+ = v0 + M^-1 J^T j        u_n >= e * approach for contacts that begin, u_n >= 0 for those that stand
///   kick        v* = v+ + h a
///   rest        v1 = v* + M^-1 J^T j        u_n >= depth / h where a gap is left, else >= 0;   Coulomb's cone
///   move        x1 = x0 + h (v+ + v1) / 2   exact for constant deceleration, and for a parabola between two bounces
///   positions   overlap that is left is parted by moving and turning alone: no speed, no energy comes of it
///
/// Sources: Moreau (1988) for the impacts (simultaneous, Newton's restitution; elastic ones without friction keep the
/// energy); Anitescu, Potra (1997) for the rest; Cline, Pai (2003) for the positions.
#pragma once

#include "stepping.h"

namespace plab::managers
{

Verdict advance_island(Island& island, Bodies& bodies, Shafts& shafts, Method& method, const StepChoices& choices, StepMemory& memory);

}  // namespace plab::managers
