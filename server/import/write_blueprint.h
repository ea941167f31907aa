/// From bodies and joints to the text of a blueprint.
#pragma once

#include <span>

#include "import/assembly.h"
#include "import/collision_rules.h"

namespace plab::import
{

struct WrittenScene
{
    std::string blueprint;  ///< XML
    std::string root;       ///< id of the first body
    std::size_t bodies = 0, joints = 0;
};

/// Adds to the document's list what pLab has no component for. `group`: "" for a whole scene; otherwise for a part of one (import.h).
WrittenScene write_blueprint(const Robot& robot, const Assembly& assembly, std::span<const CollisionExclusion> exclusions,
                             const std::string& group, Document& document);

}  // namespace plab::import
