/// Shape/Rotor: a fan's wheel about z: a hub with a rounded nose towards z, and twisted blades.
///
/// The blades are right-handed, like a ship's screw: turning positively about z it drives the air towards -z. At the
/// distance r from the axle they stand at atan(R tan(pitch) / r) to the plane of rotation: all parts of a blade would
/// screw themselves equally far in a turn.
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

/// Refuses blades that are wider than the hub can carry, or do not stand out of it.
Result<void> prepare_rotor(const StepContext& context, Row row, const RotorRows& rotors, Shapes& shapes);
Result<void> measure_rotor(Row row, const RotorRows& rotors, MassProperties& solid);

}  // namespace plab::shapes
