/// Columns that every shape has: the pose in its body, and a colour.
#pragma once

#include "plab/registrar.h"

namespace plab::shapes
{

struct ShapeColumns
{
    Column<Vec3> position;     ///< p_BS, m
    Column<Quat> orientation;  ///< q_BS
    Column<Vec3> color;        ///< red, green, blue: 0 to 1

    void describe(Schema& schema)
    {
        schema.param(position, "position", unit::metre, "origin of the shape's frame, in the body's").or_else({});
        schema.param(orientation, "orientation", unit::one, "turns the shape's axes into the body's").or_else({});
        schema.param(color, "color", unit::one, "red, green, blue, each from 0 to 1").or_else({0.8, 0.8, 0.8}).at_least(0).at_most(1);
    }
    /// X_BS.
    Pose pose(Row row) const { return {position[row], orientation[row]}; }
};

}  // namespace plab::shapes
