/// Shape/Bowl: the surface x^2 + y^2 + z^2 = radius^2, z <= opening in S, touched from inside.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

struct BowlRows
{
    ShapeColumns shape;
    Column<double> radius, opening;  ///< m

    void describe(Schema& schema);
};

/// Refuses an opening for which no surface remains.
Result<void> prepare_bowl(const StepContext& context, Row row, const BowlRows& bowls, Shapes& shapes);
/// Always refuses: a surface has no mass.
Result<void> measure_bowl(Row row, const BowlRows& bowls, MassProperties& solid);

}  // namespace plab::shapes
