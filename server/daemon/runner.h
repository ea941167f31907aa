/// Runs a loaded simulation to its end: clock, requests of the command line, output.
#pragma once

#include <atomic>

#include "daemon/options.h"
#include "simulation/simulation.h"

namespace plab::daemon
{

/// Returns the exit code. `stop` ends the run at the next step boundary.
int run(simulation::Simulation& simulation, const Options& options, const std::atomic<bool>& stop);

}  // namespace plab::daemon
