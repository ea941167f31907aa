/// Surfaces: they collide from one side only, have no mass, and are for bodies that are not dynamic (plab/surface.h).
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

/// Shape/Bowl: the surface x^2 + y^2 + z^2 = radius^2, z <= opening in S, touched from inside.
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

/// Shape/Bore: the surface x^2 + y^2 = radius^2, |z| <= height / 2 in S, touched from inside: a bore, a drum, a pipe.
struct BoreRows
{
    ShapeColumns shape;
    Column<double> radius, height;  ///< m

    void describe(Schema& schema);
};

void prepare_bore(const StepContext& context, Row row, const BoreRows& bores, Shapes& shapes);
/// Always refuses: a surface has no mass.
Result<void> measure_bore(Row row, const BoreRows& bores, MassProperties& solid);

/// Shape/HeightField: ground given by heights on a square grid.
///
///   z(i, k) = heights[k * columns + i] + wave_height sin(2 pi x / wave_length) sin(2 pi y / wave_length) + roughness u,
///   x = (i - (columns - 1) / 2) spacing,  y = (k - (rows - 1) / 2) spacing,  u uniform in [-1, 1)
///
/// Each square is divided into two triangles from (i, k) to (i + 1, k + 1). The space below them is solid; there is nothing beyond the
/// border.
struct HeightFieldRows
{
    ShapeColumns shape;
    Column<std::int64_t> columns, rows;
    Column<double> spacing;                              ///< m
    Column<Reals> heights;                               ///< m, row by row along x; none: 0
    Column<double> wave_height, wave_length, roughness;  ///< m
    Column<std::int64_t> seed;

    void describe(Schema& schema);
};

/// Refuses heights whose number is not columns * rows.
Result<void> prepare_height_field(const StepContext& context, Row row, const HeightFieldRows& fields, Shapes& shapes);
/// Always refuses: a surface has no mass.
Result<void> measure_height_field(Row row, const HeightFieldRows& fields, MassProperties& solid);

}  // namespace plab::shapes
