/// Shape/Placed: another shape at another place: X_BS = X_BP X_PS, with P the pose of this shape and X_PS the pose of the referred shape.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct PlacedRows
{
    ShapeColumns shape;
    Column<Ref> of;

    void describe(Schema& schema);
};

/// Both read the referred shape's row of the host: it must have been prepared and measured before.
Result<void> prepare_placed(const StepContext& context, Row row, const PlacedRows& placed, Shapes& shapes);
Result<void> measure_placed(Row row, const PlacedRows& placed, const Shapes& shapes, MassProperties& solid);

}  // namespace plab::shapes
