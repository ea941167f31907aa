/// A recorded run made again: from one of its snapshots on, with what was asked of it at the same steps, and the state's
/// hash beside the recorded one after each step.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "control/operations.h"
#include "record/run_log.h"
#include "replay/mismatch.h"
#include "simulation/simulation.h"

namespace plab::replay
{

struct ReplayOptions
{
    bool verify = false;
    std::optional<Tick> from;           ///< begin at the last snapshot at or before this step
    std::optional<std::uint64_t> run;   ///< only this one; else all runs of the recording, one after the other
    std::optional<double> until;        ///< s, of each run's time
    std::function<bool()> stop;         ///< asked between steps; true: the rest is not wanted
    std::function<void()> stepped;      ///< after each step
    std::function<void(double)> begun;  ///< a run begins at this time, s
};

/// What was made again of a run.
struct ReplayedRun
{
    std::uint64_t run = 0;
    Tick first = 0, last = 0;  ///< steps: of the snapshot that it began from, and of the end
    double time = 0;           ///< s, where it began
};

struct ReplayReport
{
    std::uint64_t runs = 0, requests = 0;
    std::int64_t steps = 0;     ///< made
    std::int64_t verified = 0;  ///< of them with a recorded hash
    bool interrupted = false;   ///< ReplayOptions::stop said so before the end: what came after was not made
    std::optional<Mismatch> mismatch;
    std::uint64_t last_hash = 0;
    std::vector<ReplayedRun> made;
    /// Why the replay may differ, though nothing is wrong with it: requests that the recording does not tell of.
    std::vector<std::string> doubts;
};

/// Runs in `simulation`, whose types must be those of the recording. An error: the recording has no snapshot to begin
/// from, a request cannot be carried out again, or the file is damaged where it is needed. A mismatch is no error.
Result<ReplayReport> replay(record::RunLog& log, simulation::Simulation& simulation, model::TypeSource& types,
                            const ReplayOptions& options);

}  // namespace plab::replay
