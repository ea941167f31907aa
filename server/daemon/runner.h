/// Runs a loaded simulation to its end: clock, requests, observers, output.
#pragma once

#include <atomic>

#include "daemon/ending.h"
#include "daemon/options.h"
#include "daemon/service.h"

namespace plab::daemon
{

/// Returns the exit code. `stop` ends the run at the next step boundary; the caller that sets it must wake `wake`, and set the
/// interruption that the simulation checks.
int run(simulation::Simulation& simulation, Service& service, const DaemonOptions& options, const Wake& wake,
        const std::atomic<bool>& stop);

}  // namespace plab::daemon
