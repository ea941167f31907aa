/// How a run can return to an earlier time: by named snapshots, and by rewinding.
///
/// For rewinding, the history keeps a checkpoint (a snapshot) at regular intervals of simulated time, and all requests between the
/// checkpoints with the step at which they took effect. To reach a time, Simulation::rewind() restores the last checkpoint before it and
/// makes the steps from there again, applying the recorded requests at the same steps. Because steps are deterministic this reproduces the
/// run bit for bit. Memory is bounded: beyond most_bytes every second checkpoint is dropped and the interval doubled, so the whole run
/// stays reachable at the price of more steps; beyond most_asked_bytes of requests the beginning of the run is dropped.
#pragma once

#include <deque>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "simulation/requests/requests.h"
#include "simulation/snapshot/snapshot.h"

namespace plab::simulation
{

struct HistoryOptions
{
    double interval = 0;                       ///< s of simulated time between checkpoints; 0: none, so rewinding is not possible
    std::size_t most_bytes = 64u << 20;        ///< of checkpoints; beyond it every second one is dropped and the interval is doubled
    std::size_t most_asked_bytes = 32u << 20;  ///< of requests between them; beyond it the beginning of the run is dropped
    std::size_t most_named = 64;
    std::size_t most_named_bytes = 256u << 20;
};

/// Approximate memory of a snapshot; shared parts are counted as its own.
std::size_t bytes_of(const Snapshot& snapshot);

class History
{
public:
    struct Named
    {
        Snapshot snapshot;
        std::size_t bytes = 0;
    };

    void configure(const HistoryOptions& options);
    bool can_rewind() const { return options_.interval > 0 && !checkpoints_.empty(); }
    std::size_t bytes() const { return bytes_; }              ///< of the checkpoints, approximately
    std::size_t asked_bytes() const { return asked_bytes_; }  ///< of the requests since the first checkpoint, approximately
    /// s: the earliest time of the present run that can be reached.
    double earliest() const { return checkpoints_.empty() ? std::numeric_limits<double>::infinity() : checkpoints_.front().time; }

    // Named snapshots, which outlive runs -------------------------------------------------------------------------------
    Result<void> keep(const std::string& name, const Snapshot& snapshot);
    Result<Snapshot> find(const std::string& name) const;
    Result<void> forget(const std::string& name);
    const std::map<std::string, Named>& named() const { return named_; }

    // The history of the present run --------------------------------------------------------------------------------------
    /// To be called when a new run begins: checkpoints of the last run are of no use for it.
    void begin(const Run& run);
    /// To be called after each step.
    void follow(const Run& run);
    /// To be called when a request took effect at the present boundary.
    void note(const Run& run, const Request& request);
    /// A request that took effect, and the step before which it did.
    struct Asked
    {
        Request request;
        Tick step = 0;
        std::size_t bytes = 0;
    };
    /// How to reach an earlier step again: restore the checkpoint, then make steps and carry out the requests at theirs.
    struct RewindPlan
    {
        Snapshot from;
        std::vector<Asked> requests;  ///< since then, in the order of steps
    };
    /// The way back to a time of this run, s. Errors: no history is kept, the time is in the future or is not kept any more.
    Result<RewindPlan> plan_rewind(const Run& run, double time) const;
    /// While an earlier time is computed again nothing is recorded.
    void suspend(bool is_rewinding) { is_rewinding_ = is_rewinding; }
    /// The run is at this step again: drops the checkpoints after it, and the requests at it or later.
    void cut_after(Tick step);

private:
    struct Point
    {
        Snapshot snapshot;
        Tick step = 0;
        double time = 0;  ///< s
        std::size_t bytes = 0;
    };
    void add_point(const Run& run);
    void thin();
    void give_up_earliest();

    HistoryOptions options_;
    double interval_ = 0;  ///< s: the present one, after doubling
    std::vector<Point> checkpoints_;
    std::deque<Asked> asked_;  ///< in the order of steps
    std::size_t bytes_ = 0, asked_bytes_ = 0;
    double next_ = 0;  ///< s
    std::map<std::string, Named> named_;
    bool is_rewinding_ = false;
};

}  // namespace plab::simulation
