/// A scene as it is at one time, as a blueprint that begins there.
#pragma once

#include "simulation/simulation.h"

namespace plab::daemon
{

/// The components that exist now, with their present states as initial states. What rules have made is there as plain components, and the
/// rules themselves are not.
model::SceneSpec frozen_scene(const simulation::Simulation& simulation);

}  // namespace plab::daemon
