/// Shape/ConvexHull: the smallest convex solid that contains given points or the vertices of a mesh.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

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
