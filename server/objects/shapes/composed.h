/// Shapes made of other shapes of the scene.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

/// Shape/Compound: several shapes as one. Each part keeps its own pose, and the compound's pose moves them as a whole: X_BP = X_BC X_CP.
struct CompoundRows
{
    ShapeColumns shape;
    Column<RefList> parts;

    void describe(Schema& schema);
};

/// Both read the parts' rows of the host: the parts must have been prepared and measured before.
Result<void> prepare_compound(const StepContext& context, Row row, const CompoundRows& compounds, Shapes& shapes);
Result<void> measure_compound(Row row, const CompoundRows& compounds, const Shapes& shapes, MassProperties& solid);

/// Shape/Placed: another shape at another place: X_BS = X_BP X_PS, with P the pose of this shape and X_PS the pose of the referred shape.
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
