/// State/Shaft: one degree of freedom about an axle that is fixed in the world: J w' = T, angle' = w. A prescribed shaft keeps its
/// angular velocity, whatever torque acts on it.
#pragma once

#include "body_columns.h"

namespace plab::bodies
{

struct ShaftRows
{
    Column<double> angle;             ///< rad, never wrapped
    Column<double> angular_velocity;  ///< rad/s
    Column<double> inertia;           ///< J about the axle, kg m^2
    Column<Vec3> position;            ///< of the axle's origin in W, m
    Column<Vec3> axis;                ///< axis_W, unit
    Column<bool> prescribed;
    Column<Vec3> color;
    Column<RefList> shape;  ///< for drawing
    Column<Ref> solver;

    void describe(Schema& schema);
};

/// Fills the host row except angle and speed.
Result<void> prepare_shaft(const StepContext& context, Row row, const ShaftRows& rows, Shafts& shafts);

/// The shortest rotation that turns z into `axis` (unit); about x where that is -z.
Quat rotation_from_z(const Vec3& axis);

}  // namespace plab::bodies
