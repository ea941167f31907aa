/// The size of a shape.
#pragma once

#include <algorithm>
#include <cmath>

#include "plab/tables.h"

namespace plab::world
{

/// m: the largest distance of a point of the shape from the origin of its own frame; infinite for a plane.
inline double bounding_radius(const Geometry& g)
{
    double r = 0;
    if (g.kind == GeometryKind::Plane) return HUGE_VAL;
    if (g.kind == GeometryKind::Sphere) r = g.size.x;
    if (g.kind == GeometryKind::Box) r = length(g.size);
    if (g.kind == GeometryKind::Capsule) r = g.size.x + g.size.z;
    if (g.kind == GeometryKind::Cylinder) r = std::hypot(g.size.x, g.size.z);
    for (const Vec3& v : g.vertices) r = std::max(r, length(v));
    return r;
}

}  // namespace plab::world
