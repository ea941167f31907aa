/// A loaded scene as MJCF (mujoco.readthedocs.io, "XML reference"), as far as that can say it. server/docs/importing.md has the table.
#pragma once

#include <string>

#include "plab/result.h"
#include "world/world.h"

namespace plab::exported
{

struct ExportedScene
{
    std::string text;  ///< XML
    Errors losses;     ///< component and reason
    std::size_t bodies = 0, joints = 0;
};

/// The scene at its present state; `dt`: s.
ExportedScene write_mjcf(const world::World& world, double dt);

}  // namespace plab::exported
