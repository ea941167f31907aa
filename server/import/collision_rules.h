/// Which bodies and shapes of a robot do not collide, as the formats say it: parent and child, links of a model, masks, exclusions, pairs.
#pragma once

#include <vector>

#include "import/assembly.h"

namespace plab::import
{

/// A body with all its shapes, or one shape of it.
struct CollisionMember
{
    static constexpr std::size_t kAll = std::size_t(-1);
    std::size_t body = 0, shape = kAll;
};

/// No two members of `within` collide, and none of `a` collides with one of `b`.
struct CollisionExclusion
{
    std::vector<CollisionMember> within, a, b;
};

/// Shapes that may collide with nothing are only seen from now on. Errors: exclusions and pairs of what is not there.
std::vector<CollisionExclusion> collision_rules(const Robot& robot, Assembly& assembly, Document& document);

}  // namespace plab::import
