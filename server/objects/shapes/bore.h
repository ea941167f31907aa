/// Shape/Bore: the surface x^2 + y^2 = radius^2, |z| <= height / 2 in S, touched from inside: a bore, a drum, a pipe.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct BoreRows
{
    ShapeColumns shape;
    Column<double> radius, height;  ///< m

    void describe(Schema& schema);
};

void prepare_bore(const StepContext& context, Row row, const BoreRows& bores, Shapes& shapes);
/// Always refuses: a surface has no mass.
Result<void> measure_bore(Row row, const BoreRows& bores, MassProperties& solid);

}  // namespace plab::shapes
