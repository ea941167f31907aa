/// A <link> of SDF: mass, shapes, and whether gravity acts on it.
#pragma once

#include "import/robot.h"
#include "import/sdf_files.h"
#include "import/sdf_frames.h"

namespace plab::import
{

/// All but name and pose. `scope`: full name of its model; `full`: its own. `fixed`: it never moves, so its mass does not matter.
RobotBody read_sdf_link(const XmlElement& e, const std::string& scope, const std::string& full, bool fixed, SdfFrames& frames,
                        const SdfFiles& files, Document& document);

}  // namespace plab::import
