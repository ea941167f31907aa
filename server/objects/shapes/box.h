/// Shape/Box: |x| <= a, |y| <= b, |z| <= c in S.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct BoxRows
{
    ShapeColumns shape;
    Column<Vec3> half_extents;  ///< (a, b, c), m

    void describe(Schema& schema);
};

void prepare_box(const StepContext& context, Row row, const BoxRows& boxes, Shapes& shapes);
void measure_box(Row row, const BoxRows& boxes, MassProperties& solid);

}  // namespace plab::shapes
