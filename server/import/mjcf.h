/// From MJCF to bodies and joints (mujoco.readthedocs.io, "XML reference").
#pragma once

#include "import/document.h"
#include "import/robot.h"

namespace plab::import
{

/// `root`: <mujoco>. Errors and losses go into `document`; after an error the result is incomplete.
Robot read_mjcf(XmlElement root, bool fixed_base, Document& document);

}  // namespace plab::import
