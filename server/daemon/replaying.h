/// plabd --replay: replays and verifies recorded runs.
#pragma once

#include <atomic>

#include "daemon/options.h"
#include "plugins/library.h"

namespace plab::daemon
{

/// `interruption` abandons the current step. Returns the exit code: 0 done, and with --verify all hashes are identical; 1 they
/// differ, or a replay is not possible.
int replay_recording(plugins::PluginLibrary& library, const DaemonOptions& options, const std::atomic<bool>& stop,
                     const Interruption& interruption);

}  // namespace plab::daemon
