/// --explain: what a scene loads, what was resolved how, and what it does without.
#pragma once

#include <string>

#include "plugins/library.h"
#include "simulation/simulation.h"

namespace plab::daemon
{

std::string explain(const simulation::Simulation& simulation, const plugins::PluginLibrary& library);

/// What solvers that choose by the state chose in the step just made; empty if the scene has none.
std::string explain_choices(const simulation::Simulation& simulation);

}  // namespace plab::daemon
