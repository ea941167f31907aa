/// Closed forms for the pairs of shapes that have one; accurate to rounding.
#pragma once

#include "contact_points.h"
#include "solid.h"

namespace plab::detection
{

/// depth = r_a + r_b - |c_b - c_a|.
void sphere_sphere(double radius_a, const Vec3& a, double radius_b, const Vec3& b, ContactPoints& out);
/// depth = r - n . (c - p); the plane is solid below, on the side opposite to n.
void sphere_plane(double radius, const Vec3& center, const Pose& X_plane, ContactPoints& out);
/// depth = r - |c - nearest point|, or r + distance to the nearest face if the centre is inside.
void sphere_box(double radius, const Vec3& center, const Vec3& half, const Pose& X_box, ContactPoints& out);
/// All corners below the plane; depth = -n . (corner - p).
void box_plane(const Vec3& half, const Pose& X_box, const Pose& X_plane, ContactPoints& out);
/// The deepest vertex, and the outermost vertices below the plane in 8 directions.
void hull_plane(const Hull& hull, const Pose& X_hull, const Pose& X_plane, ContactPoints& out);
/// Both ends of the segment; depth = r - n . (end - p).
void capsule_plane(const Solid& capsule, const Pose& X_plane, ContactPoints& out);
/// The lowest point of the rim at each end, and four points fixed to the body on the rim of the end that faces down. A rolling
/// cylinder is thus carried by two points, a standing one by four or five.
void cylinder_plane(const Solid& cylinder, const Pose& X_plane, ContactPoints& out);

}  // namespace plab::detection
