/// Shape/Mesh: triangles, drawn and integrated as given; collides as its convex hull, as a surface, or not at all.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

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

}  // namespace plab::shapes
