/// The scene of the command line: a blueprint, or the file of another program, which becomes one.
#pragma once

#include "daemon/options.h"
#include "model/blueprint.h"
#include "plugins/library.h"
#include "simulation/simulation.h"

namespace plab::daemon
{

/// What a file of another program loses on the way is written to the log.
Result<model::Blueprint> read_scene(const DaemonOptions& options);

/// Task::Import: writes the blueprint, once it is known to load, whole or not at all; the list of losses goes to standard error.
int import_scene(plugins::PluginLibrary& library, const DaemonOptions& options);

/// Task::Export: writes the scene as it is, whole or not at all; what the format cannot say goes to standard error.
int export_scene(const simulation::Simulation& simulation, const DaemonOptions& options);

}  // namespace plab::daemon
