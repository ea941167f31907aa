/// The convex hull of a mesh, with the adjacency that collision needs.
#pragma once

#include "plab/convex_hull.h"
#include "point_columns.h"

namespace plab::detection
{

/// A convex polyhedron, with the edges and polygons formed by its triangles.
struct Hull : ConvexHull
{
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< edges between triangles that are not coplanar
    /// Coplanar triangles are merged to polygons: polygon i is loop[loop_end[i - 1] .. loop_end[i]), counter-clockwise.
    std::vector<std::uint32_t> loop, loop_end;
    std::vector<Vec3> loop_normals;
    Vec3 lower, upper;  ///< bounds, m
    Vec3 center;        ///< mean of the vertices, m; it is inside
    double extent = 0;  ///< m: the largest distance of a vertex from the centre
    /// Of each triangle: its middle, and the largest distance of a corner from it, m.
    std::vector<Vec3> middles;
    std::vector<double> reaches;
    PointColumns vertex_columns, loop_normal_columns;
};

Result<Hull> make_hull(std::span<const Vec3> points);

}  // namespace plab::detection
