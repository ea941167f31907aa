/// Shape/Rotor: the wheel of a fan about z: a hub with a rounded nose towards z, and twisted blades.
///
/// The blades are right-handed like a ship's propeller: turning positively about z, the rotor drives air towards -z. At distance r from
/// the axle a blade is inclined to the plane of rotation by atan(R tan(pitch) / r), so all its parts have the same pitch, the advance per
/// turn.
#pragma once

#include "built_mesh.h"
#include "shape_columns.h"

namespace plab::shapes
{

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
