/// From SDF (sdformat.org, versions 1.4 to 1.11; poses as since 1.7) to bodies and joints: a world, or one model.
#pragma once

#include <string>
#include <vector>

#include "import/document.h"
#include "import/robot.h"

namespace plab::import
{

/// `root`: <sdf>. `folders`: where model:// is looked for. Errors and losses go into `document`; after an error the result is incomplete.
Robot read_sdf(const XmlElement& root, const std::vector<std::string>& folders, bool fixed_base, Document& document);

}  // namespace plab::import
