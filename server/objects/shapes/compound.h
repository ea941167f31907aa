/// Shape/Compound: several shapes that are one, each at the pose that it has by itself, moved as a whole by that of the
/// compound: X_BP = X_BC X_CP.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct CompoundRows
{
    ShapeColumns shape;
    Column<RefList> parts;

    void describe(Schema& schema);
};

/// Both read what the host knows of the parts: they must have been prepared and measured before.
Result<void> prepare_compound(const StepContext& context, Row row, const CompoundRows& compounds, Shapes& shapes);
Result<void> measure_compound(Row row, const CompoundRows& compounds, const Shapes& shapes, MassProperties& solid);

}  // namespace plab::shapes
