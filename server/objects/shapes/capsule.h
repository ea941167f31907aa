/// Shape/Capsule: all points within `radius` of a segment along z of S: a cylinder with round ends.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct CapsuleRows
{
    ShapeColumns shape;
    Column<double> radius, length;  ///< m; length of the segment, so of the straight part

    void describe(Schema& schema);
};

void prepare_capsule(const StepContext& context, Row row, const CapsuleRows& capsules, Shapes& shapes);
void measure_capsule(Row row, const CapsuleRows& capsules, MassProperties& solid);

}  // namespace plab::shapes
