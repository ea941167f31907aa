/// Shape/Cylinder: x^2 + y^2 <= radius^2, |z| <= height / 2 in S. Collision and mass properties use the exact solid.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct CylinderRows
{
    ShapeColumns shape;
    Column<double> radius, height;  ///< m
    Column<bool> hull_collides;

    void describe(Schema& schema);
};

void prepare_cylinder(const StepContext& context, Row row, const CylinderRows& cylinders, Shapes& shapes);
void measure_cylinder(Row row, const CylinderRows& cylinders, MassProperties& solid);

}  // namespace plab::shapes
