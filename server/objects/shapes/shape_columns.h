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

    void describe(Schema& schema);
    /// X_BS.
    Pose pose(Row row) const { return {position[row], orientation[row]}; }
};

}  // namespace plab::shapes
