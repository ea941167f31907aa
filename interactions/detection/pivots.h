/// What a solid pivots about where one of its corners, round ends or rims touches a face.
#pragma once

#include "plab/collision.h"
#include "solid.h"

namespace plab::detection
{

/// `corner`: the point of the core with this number (visit_corners() in surface_contacts.h), `point`: the contact point.
Pivot pivot_at_corner(Pivot::Of of, const Solid& solid, std::uint32_t number, const Vec3& corner, const Vec3& point);
/// The same for a point of an edge, or of the side of a round solid.
Pivot pivot_at_edge(Pivot::Of of, const Solid& solid, const Vec3& on_edge, const Vec3& point);
/// The same for the corner that is furthest in direction d.
Pivot pivot_at_end(Pivot::Of of, const Solid& solid, const Vec3& d, const Vec3& corner, const Vec3& point);

}  // namespace plab::detection
