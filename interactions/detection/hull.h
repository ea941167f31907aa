/// The convex hull of a mesh: what a mesh collides as.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/result.h"
#include "plab/vector.h"

namespace plab::detection
{

/// A closed convex polyhedron of triangles. normals[f] . p <= offsets[f] for all points p inside.
struct Hull
{
    std::vector<Vec3> vertices;                       ///< m; only those on the hull, in the order in which they were given
    std::vector<std::array<std::uint32_t, 3>> faces;  ///< counter-clockwise seen from outside
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< those between faces that are not in one plane
    std::vector<Vec3> normals;                        ///< unit, outwards, one per face
    std::vector<double> offsets;                      ///< m
    Vec3 lower, upper;                                ///< bounds, m
    Vec3 center;                                      ///< mean of the vertices, m; inside
};

/// Quickhull (Barber, Dobkin, Huhdanpaa, ACM TOMS 22, 1996). Points within 1e-12 of the extent above a face count as on
/// it and are dropped; so the hull is right to that. Fails for points that do not span a volume.
Result<Hull> make_hull(std::span<const Vec3> points);

}  // namespace plab::detection
