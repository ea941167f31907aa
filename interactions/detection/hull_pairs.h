/// Two convex polyhedra by the Minkowski portal method.
#pragma once

#include "narrow.h"

namespace plab::detection
{

/// Depth and normal are those of the face of A - B that the line of the centres leaves through: right to rounding, and
/// zero exactly when the two just touch. ODE's own convex pairs (libccd) take the normal from the nearest point
/// instead, whose direction is lost as the depth goes to zero, just where an impact is located. Source: Snethen,
/// "XenoCollide: complex collision made simple", Game Programming Gems 7 (2008).
void hull_hull(const Hull& a, const Pose& X_a, const Hull& b, const Pose& X_b, Touches& out);

}  // namespace plab::detection
