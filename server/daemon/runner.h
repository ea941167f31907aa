/// Runs a loaded simulation to its end: clock, requests, observers, output.
#pragma once

#include <atomic>
#include <chrono>

#include "daemon/options.h"
#include "daemon/service.h"

namespace plab::daemon
{

/// What is in work when the end is asked for has this long to come to its end before it is given up.
inline constexpr std::chrono::milliseconds kGrace(250);
/// A step was given up: the run ends where it began.
inline constexpr int kExitGaveUp = 3;

/// Returns the exit code. `stop` ends the run at the next step boundary; whoever sets it wakes `wake`, and asks the interruption that
/// the simulation obeys.
int run(simulation::Simulation& simulation, Service& service, const Options& options, const Wake& wake, const std::atomic<bool>& stop);

}  // namespace plab::daemon
