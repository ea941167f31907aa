/// A joint, and what acts along its coordinate, as components.
#pragma once

#include <string>
#include <vector>

#include "import/assembly.h"
#include "import/component_text.h"

namespace plab::import
{

struct JointText
{
    std::string id;
    std::string place;               ///< attributes that say between which bodies, where and along what its coordinate is
    std::vector<std::string> lines;  ///< one component each
    bool needs_manager = false;      ///< of the id "manager"
};

/// The joint that holds body `b` to body `a` ("": the world). Coordinates of components are q - start.
JointText joint_text(const PlacedJoint& placed, const std::string& a, const std::string& b, Ids& ids);

/// `start`: q of its joint at the beginning.
std::string actuator_text(const Actuator& actuator, const std::string& place, double start, Ids& ids);

}  // namespace plab::import
