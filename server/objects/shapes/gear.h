/// Shape/Gear: a spur wheel about z with straight-flanked (trapezoid) teeth, one of them in the direction of x.
///
/// With pitch radius r and z teeth the module is m = 2 r / z. Tips are at r + m and roots at r - 1.25 m; flanks are inclined by 20
/// degrees. Two gears mesh if their modules are equal and the distance of their axles is r1 + r2.
#pragma once

#include "built_mesh.h"
#include "shape_columns.h"

namespace plab::shapes
{

struct GearRows
{
    ShapeColumns shape;
    Column<double> pitch_radius;  ///< r, m
    Column<std::int64_t> teeth;   ///< z
    Column<double> width, bore;   ///< along z; radius of the hole; m
    Column<bool> hull_collides;

    void describe(Schema& schema);
};

/// Refuses a bore that leaves no ring of material below the teeth.
Result<void> prepare_gear(const StepContext& context, Row row, const GearRows& gears, Shapes& shapes);
Result<void> measure_gear(Row row, const GearRows& gears, MassProperties& solid);

}  // namespace plab::shapes
