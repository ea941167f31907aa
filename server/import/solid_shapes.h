/// Mass properties of shapes.
#pragma once

#include "import/robot.h"
#include "plab/result.h"

namespace plab::import
{

/// Of density 1, in the shape's frame; zero for planes. Errors: a mesh without volume.
Result<MassProperties> solid_of(const RobotShape& shape);

}  // namespace plab::import
