/// What a link looks like and what of it collides, in formats that state the two apart (URDF, SDF).
#pragma once

#include <string>
#include <vector>

#include "import/document.h"
#include "import/robot.h"

namespace plab::import
{

/// A shape that is both seen and felt is one shape of pLab; other shapes that collide are drawn as well, and listed if others are `seen`.
std::vector<RobotShape> joined_shapes(std::vector<RobotShape> seen, std::vector<RobotShape> felt, const std::string& link,
                                      Document& document);

}  // namespace plab::import
