/// Shape/Compound: several shapes as one. Each part keeps its own pose, and the compound's pose moves them as a whole: X_BP = X_BC X_CP.
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

/// Both read the parts' rows of the host: the parts must have been prepared and measured before.
Result<void> prepare_compound(const StepContext& context, Row row, const CompoundRows& compounds, Shapes& shapes);
Result<void> measure_compound(Row row, const CompoundRows& compounds, const Shapes& shapes, MassProperties& solid);

}  // namespace plab::shapes
