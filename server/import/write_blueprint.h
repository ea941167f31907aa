/// From bodies and joints to the text of a blueprint.
#pragma once

#include "import/assembly.h"
#include "import/import.h"

namespace plab::import
{

/// Adds to the document's list what pLab has no component for.
ImportedScene write_blueprint(const Robot& robot, const Assembly& assembly, Document& document);

}  // namespace plab::import
