/// Shape/Plane: the half space z <= 0 in S; its surface is seen from z > 0.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct PlaneRows
{
    ShapeColumns shape;

    void describe(Schema& schema) { shape.describe(schema); }
};

void prepare_plane(const StepContext& context, Row row, const PlaneRows& planes, Shapes& shapes);
/// Always refuses: a half space has no mass.
Result<void> measure_plane(Row row, const PlaneRows& planes, MassProperties& solid);

}  // namespace plab::shapes
