/// From bodies and joints to the text of a blueprint.
#pragma once

#include "import/assembly.h"

namespace plab::import
{

struct WrittenScene
{
    std::string blueprint;  ///< XML
    std::size_t bodies = 0, joints = 0;
};

/// Adds to the document's list what pLab has no component for.
WrittenScene write_blueprint(const Robot& robot, const Assembly& assembly, Document& document);

}  // namespace plab::import
