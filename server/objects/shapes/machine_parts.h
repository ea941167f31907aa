/// Wheels of machines, drawn and integrated as closed meshes.
#pragma once

#include "built_mesh.h"
#include "shape_columns.h"

namespace plab::shapes
{

/// Shape/Gear: a spur wheel about z with straight-flanked (trapezoid) teeth, one of them in the direction of x.
///
/// With pitch radius r and z teeth the module is m = 2 r / z. Tips are at r + m and roots at r - 1.25 m; flanks are inclined by 20
/// degrees. Two gears mesh if their modules are equal and the distance of their axles is r1 + r2.
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

/// Shape/Rotor: the wheel of a fan about z: a hub with a rounded nose towards z, and twisted blades.
///
/// The blades are right-handed like a ship's propeller: turning positively about z, the rotor drives air towards -z. At distance r from
/// the axle a blade is inclined to the plane of rotation by atan(R tan(pitch) / r), so all its parts have the same pitch, the advance per
/// turn.
struct RotorRows
{
    ShapeColumns shape;
    Column<double> hub_radius, radius;  ///< m
    Column<std::int64_t> blades;
    Column<double> pitch_angle;  ///< at the tips, rad
    Column<double> width;        ///< of a blade, along its section, m
    Column<bool> hull_collides;

    void describe(Schema& schema);
};

/// Refuses blades that are wider than the hub can carry, or that do not extend beyond it.
Result<void> prepare_rotor(const StepContext& context, Row row, const RotorRows& rotors, Shapes& shapes);
Result<void> measure_rotor(Row row, const RotorRows& rotors, MassProperties& solid);

}  // namespace plab::shapes
