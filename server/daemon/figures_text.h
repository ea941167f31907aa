/// Figures of a scene as text, for the files that plabd writes.
#pragma once

#include <string>

#include "world/world.h"

namespace plab::daemon
{

/// 17 significant digits; "null" for what is not finite.
std::string number(double v);

/// Components with motion or values of their own.
bool is_shown(const world::Component& component);
/// Components listed under "interactions"; solvers appear with their groups (--explain).
bool is_listed(const world::World& world, std::uint32_t component);

}  // namespace plab::daemon
