/// From URDF to bodies and joints (wiki.ros.org/urdf/XML).
#pragma once

#include "import/document.h"
#include "import/robot.h"

namespace plab::import
{

/// `root`: <robot>. Errors and losses go into `document`; after an error the result is incomplete.
Robot read_urdf(const XmlElement& root, bool fixed_base, bool self_collide, Document& document);

}  // namespace plab::import
