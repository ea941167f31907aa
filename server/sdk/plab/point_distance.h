/// The distance of a point from a body's shapes, in closed form.
///
/// Boxes, capsules and cylinders by their signed distance functions (I. Quilez, Distance functions, 2008); meshes by the nearest triangle
/// (C. Ericson, Real-time collision detection, 2005, section 5.1.5).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "plab/tables.h"

namespace plab
{
namespace detail
{

/// m; of a box with these half extents, or, in two dimensions, of a rectangle (z = 0).
inline double distance_to_box(const Vec3& p, const Vec3& half)
{
    const Vec3 q{std::fabs(p.x) - half.x, std::fabs(p.y) - half.y, std::fabs(p.z) - half.z};
    const Vec3 outside{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
    return length(outside) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

inline double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return length(ap);
    if (d3 >= 0 && d4 <= d3) return length(bp);
    if (d6 >= 0 && d5 <= d6) return length(cp);
    const double in_c = d1 * d4 - d3 * d2, in_b = d5 * d2 - d1 * d6, in_a = d3 * d6 - d5 * d4;
    if (in_c <= 0 && d1 >= 0 && d3 <= 0) return length(ap - ab * (d1 / (d1 - d3)));
    if (in_b <= 0 && d2 >= 0 && d6 <= 0) return length(ap - ac * (d2 / (d2 - d6)));
    if (in_a <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return length(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    return length(ap - (ab * in_b + ac * in_c) / (in_a + in_b + in_c));
}

}  // namespace detail

/// m, from a point in the frame of S to the surface of a shape; negative inside, except for meshes, which have no inside here. Infinite for
/// a shape without a surface.
inline double distance_to(const Shapes& shapes, std::uint32_t shape, const Vec3& p_B)
{
    const Geometry& g = shapes.geometry[shape];
    const Vec3 p = rotate_back(g.pose.q, p_B - g.pose.p);
    double nearest = std::numeric_limits<double>::infinity();
    switch (g.kind)
    {
        case GeometryKind::None:
            break;
        case GeometryKind::Sphere:
            return length(p) - g.size.x;
        case GeometryKind::Box:
            return detail::distance_to_box(p, g.size);
        case GeometryKind::Plane:
            return p.z;
        case GeometryKind::Capsule:
            return length(p - Vec3{0, 0, std::clamp(p.z, -g.size.z, g.size.z)}) - g.size.x;
        case GeometryKind::Cylinder:
            return detail::distance_to_box({std::sqrt(p.x * p.x + p.y * p.y), 0, p.z},
                                           {g.size.x, std::numeric_limits<double>::max(), g.size.z});
        case GeometryKind::Mesh:
            for (std::size_t t = 0; t + 2 < g.triangles.size(); t += 3)
                nearest = std::min(nearest, detail::distance_to_triangle(p, g.vertices[g.triangles[t]], g.vertices[g.triangles[t + 1]],
                                                                         g.vertices[g.triangles[t + 2]]));
            break;
        case GeometryKind::Compound:
            for (const std::uint32_t part : g.parts) nearest = std::min(nearest, distance_to(shapes, part, p));
            break;
    }
    return nearest;
}

/// m, from a point in W to the nearest shape of a body; to its origin if it has none.
inline double distance_to_body(const Bodies& bodies, const Shapes& shapes, std::uint32_t body, const Vec3& p_W)
{
    const Pose pose = bodies.pose(body);
    const Vec3 p_B = rotate_back(pose.q, p_W - pose.p);
    if (bodies.shapes[body].empty()) return length(p_B);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Ref shape : bodies.shapes[body]) nearest = std::min(nearest, distance_to(shapes, shape.index, p_B));
    return nearest;
}

}  // namespace plab
