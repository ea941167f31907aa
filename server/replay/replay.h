/// Replays a recorded run: starts from one of its snapshots, carries out the recorded requests at the same steps, and compares
/// the state's hash with the recorded one after each step.
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
    std::optional<Tick> from;           ///< start at the last snapshot at or before this step
    std::optional<std::uint64_t> run;   ///< only this run; otherwise all runs of the recording, one after the other
    std::optional<double> until;        ///< s, in the time of each run
    std::function<bool()> stop;         ///< called between steps; true: stop the replay
    std::function<void()> stepped;      ///< after each step
    std::function<void(double)> begun;  ///< called when a run begins, with its time, s
};

/// The replayed part of a run.
struct ReplayedRun
{
    std::uint64_t run = 0;
    Tick first = 0, last = 0;  ///< steps: of the snapshot where it started, and of the end
    double time = 0;           ///< s, where it started
};

struct ReplayReport
{
    std::uint64_t runs = 0, requests = 0;
    std::int64_t steps = 0;     ///< steps made
    std::int64_t verified = 0;  ///< number of these steps with a recorded hash
    bool interrupted = false;   ///< ReplayOptions::stop ended it early: what follows was not replayed
    std::optional<Mismatch> mismatch;
    std::uint64_t last_hash = 0;
    std::vector<ReplayedRun> made;
    /// Why the replay may differ although nothing is wrong with it: requests that the recording does not contain.
    std::vector<std::string> doubts;
};

/// Replays in `simulation`, whose types must be those of the recording. An error: the recording has no snapshot to start from,
/// a request cannot be carried out again, or the file is damaged at a place that is needed. A mismatch is not an error.
Result<ReplayReport> replay(record::RunLog& log, simulation::Simulation& simulation, model::TypeSource& types,
                            const ReplayOptions& options);

}  // namespace plab::replay
