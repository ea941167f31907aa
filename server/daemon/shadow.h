/// plabd --shadow: what a swap would do, before it is done.
#pragma once

#include <atomic>

#include "daemon/options.h"
#include "plugins/library.h"

namespace plab::daemon
{

/// A snapshot's future twice, in turn, some steps at a time: as it is, and with one interaction exchanged. Prints how far they
/// part, object by object, and what each costs: CPU time of the step thread, the median of pieces and the mean. Returns the
/// exit code.
int run_shadow(plugins::PluginLibrary& library, const DaemonOptions& options, const std::atomic<bool>& stop,
               const Interruption& interruption);

}  // namespace plab::daemon
