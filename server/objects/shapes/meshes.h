/// Shapes given by points: triangle meshes, and the convex hull of a set of points.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

/// Shape/Mesh: triangles, drawn and integrated as given; collides as its convex hull, as a surface, or not at all.
struct MeshRows
{
    ShapeColumns shape;
    Column<Reals> vertices;      ///< x y z of each, in S, m
    Column<Integers> triangles;  ///< index triples, counter-clockwise seen from outside
    Column<bool> hull_collides, surface_collides;

    void describe(Schema& schema);
};

/// Accepts open meshes, because they can be drawn.
Result<void> prepare_mesh(const StepContext& context, Row row, const MeshRows& meshes, Shapes& shapes);
Result<void> measure_mesh(Row row, const MeshRows& meshes, MassProperties& solid);

/// Shape/ConvexHull: the smallest convex solid that contains given points or the vertices of a mesh.
struct ConvexHullRows
{
    ShapeColumns shape;
    Column<Reals> points;  ///< x y z of each, in S, m
    Column<Ref> of;        ///< a shape with vertices, which are added to the points

    void describe(Schema& schema);
};

Result<void> prepare_convex_hull(const StepContext& context, Row row, const ConvexHullRows& hulls, Shapes& shapes);
Result<void> measure_convex_hull(Row row, const ConvexHullRows& hulls, const Shapes& shapes, MassProperties& solid);

}  // namespace plab::shapes
