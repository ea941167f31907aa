/// Signed distance of two solids: closed forms where they exist, otherwise closest points (GJK) or penetration depth (EPA).
#pragma once

#include <cmath>

#include "contact_points.h"
#include "solid.h"

namespace plab::detection
{

/// Of the solids including their rounding radii. `beyond`, m: of a gap that is larger than this, some lower bound larger than this
/// suffices, without points and normal.
Separation separation_of(const Solid& a, const Solid& b, double beyond = HUGE_VAL);
/// Of a solid and the half-space z <= 0 of X_plane; exact.
Separation separation_from_plane(const Solid& a, const Pose& X_plane);

}  // namespace plab::detection
