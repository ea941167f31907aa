/// Columns that all bodies have: pose, appearance, material and velocity.
///
/// Pose and velocities are hosted: these columns hold the initial values, Bodies the live ones.
#pragma once

#include <string>

#include "plab/registrar.h"

namespace plab::bodies
{

struct BodyColumns
{
    Column<Vec3> position;     ///< p_WB, m
    Column<Quat> orientation;  ///< q_WB
    Column<std::string> material;
    Column<Vec3> color;  ///< red, green, blue: 0 to 1
    Column<RefList> shape;

    void describe(Schema& schema);
};

struct VelocityColumns
{
    Column<Vec3> linear;   ///< v_WB of B's origin, m/s
    Column<Vec3> angular;  ///< w_WB in W, rad/s

    void describe(Schema& schema);
};

/// `color`, for bodies and shafts alike.
void describe_color(Column<Vec3>& color, Schema& schema);
/// The role `solver`: the solver that advances the object.
void describe_solver(Column<Ref>& solver, Schema& schema);

/// Fills the host row of a body that is not dynamic: no mass, no inverse mass, centre at B's origin.
void fill_unpushed(std::uint32_t index, Motion motion, Row row, const BodyColumns& body, Bodies& bodies, Materials& materials);

}  // namespace plab::bodies
