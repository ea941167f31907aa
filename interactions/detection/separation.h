/// Signed distance of two solids: closed forms where there are any, else nearest points or least depth.
#pragma once

#include "contact_points.h"
#include "solid.h"

namespace plab::detection
{

/// Of the solids with their rounding radii.
Separation separation_of(const Solid& a, const Solid& b);
/// Of a solid and the half-space below z of X_plane; exact.
Separation separation_from_plane(const Solid& a, const Pose& X_plane);

}  // namespace plab::detection
