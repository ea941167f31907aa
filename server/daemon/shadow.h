/// plabd --shadow: shows the effect of a swap before it is made.
#pragma once

#include <atomic>

#include "daemon/options.h"
#include "plugins/library.h"

namespace plab::daemon
{

/// Simulates two futures of a snapshot, alternating after a number of steps: one unchanged, one with an interaction exchanged.
/// Prints how far they diverge, object by object, and what each costs: CPU time of the step thread, the median of pieces and
/// the mean. Returns the exit code.
int run_shadow(plugins::PluginLibrary& library, const DaemonOptions& options, const std::atomic<bool>& stop,
               const Interruption& interruption);

}  // namespace plab::daemon
