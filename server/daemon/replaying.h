/// plabd --replay: recorded runs made again, and verified.
#pragma once

#include <atomic>

#include "daemon/options.h"
#include "plugins/library.h"

namespace plab::daemon
{

/// `interruption` gives up the step in work. Returns the exit code: 0 done, and with --verify all hashes are the same; 1 they differ, or it
/// cannot be replayed.
int replay_recording(plugins::PluginLibrary& library, const DaemonOptions& options, const std::atomic<bool>& stop,
                     const Interruption& interruption);

}  // namespace plab::daemon
