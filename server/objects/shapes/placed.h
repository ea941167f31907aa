/// Shape/Placed: another shape, moved as a whole: X_BS = X_BP X_PS, with P this shape's own pose and X_PS the pose
/// that the referred shape has by itself.
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

/// Both read what the host knows of the referred shape: it must have been prepared and measured before.
Result<void> prepare_placed(const StepContext& context, Row row, const PlacedRows& placed, Shapes& shapes);
Result<void> measure_placed(Row row, const PlacedRows& placed, const Shapes& shapes, MassProperties& solid);

}  // namespace plab::shapes
