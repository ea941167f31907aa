/// --explain: what a scene loads, what was resolved how, and what it does without.
#pragma once

#include <string>

#include "plugins/library.h"
#include "simulation/simulation.h"

namespace plab::daemon
{

std::string explain(const simulation::Simulation& simulation, const plugins::PluginLibrary& library);

}  // namespace plab::daemon
