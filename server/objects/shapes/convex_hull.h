/// Shape/ConvexHull: the smallest convex solid that holds some points, given here or by a mesh.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct ConvexHullRows
{
    ShapeColumns shape;
    Column<Reals> points;  ///< x y z of each, in S, m
    Column<Ref> of;        ///< a shape with vertices, whose points join them

    void describe(Schema& schema);
};

Result<void> prepare_convex_hull(const StepContext& context, Row row, const ConvexHullRows& hulls, Shapes& shapes);
Result<void> measure_convex_hull(Row row, const ConvexHullRows& hulls, const Shapes& shapes, MassProperties& solid);

}  // namespace plab::shapes
