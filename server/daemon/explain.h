/// --explain: what a scene loads, how its algorithms are resolved, and what it does not need.
#pragma once

#include <string>

#include "plugins/library.h"
#include "simulation/simulation.h"

namespace plab::daemon
{

std::string explain(const simulation::Simulation& simulation, const plugins::PluginLibrary& library);

/// The choices that state-dependent solvers made in the last step; empty if the scene has none.
std::string explain_choices(const simulation::Simulation& simulation);

/// The rules of the scene, and what they have made so far; empty if there are none.
std::string explain_rules(const simulation::Simulation& simulation);

}  // namespace plab::daemon
