/// Shape/Sphere: all points within `radius` of the origin of S.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct SphereRows
{
    ShapeColumns shape;
    Column<double> radius;  ///< m

    void describe(Schema& schema);
};

void prepare_sphere(const StepContext& context, Row row, const SphereRows& spheres, Shapes& shapes);
void measure_sphere(Row row, const SphereRows& spheres, MassProperties& solid);

}  // namespace plab::shapes
