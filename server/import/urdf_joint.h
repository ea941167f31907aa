/// A <joint> of URDF as joints of the model: one, none (fixed, floating) or three (planar).
#pragma once

#include <optional>

#include "import/document.h"
#include "import/robot.h"

namespace plab::import
{

struct UrdfJoint
{
    std::string name, parent, child;
    Pose pose;  ///< of the child in the parent
    std::vector<Joint> joints;
    bool floating = false;
    std::string mimics;  ///< "": none
    double multiplier = 1, offset = 0;
    TextPosition where;
};

/// All but its pose. None if it is faulty; then with an error.
std::optional<UrdfJoint> read_urdf_joint(const XmlElement& e, Document& document);

}  // namespace plab::import
