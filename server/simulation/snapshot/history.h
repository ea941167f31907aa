/// How far a run can go back: snapshots that somebody named, and, if it is kept, a snapshot now and then with what was asked
/// between them, from which any step of the run can be made again.
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
    double interval = 0;                       ///< s, simulated, between snapshots of its own; 0: none, and nothing can be rewound
    std::size_t most_bytes = 64u << 20;        ///< of those; beyond it every second one is given up and they come half as often
    std::size_t most_asked_bytes = 32u << 20;  ///< of requests between them; beyond it the earliest of the run is given up
    std::size_t most_named = 64;
    std::size_t most_named_bytes = 256u << 20;
};

/// About what a snapshot holds in memory, shared parts counted as its own.
std::size_t bytes_of(const Snapshot& snapshot);

class Simulation;

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
    std::size_t bytes() const { return bytes_; }              ///< of the course, about
    std::size_t asked_bytes() const { return asked_bytes_; }  ///< of what was asked since its first point, about
    /// s: the earliest time of the present run that rewind() reaches.
    double earliest() const { return checkpoints_.empty() ? std::numeric_limits<double>::infinity() : checkpoints_.front().time; }

    // Snapshots with names: they outlive runs ---------------------------------------------------------------------------
    Result<void> keep(const std::string& name, const Snapshot& snapshot);
    Result<Snapshot> find(const std::string& name) const;
    Result<void> forget(const std::string& name);
    const std::map<std::string, Named>& named() const { return named_; }

    // The course of the present run --------------------------------------------------------------------------------------
    /// A new run stands at its beginning: what was kept of the last one is worth nothing to it.
    void begin(const Simulation& simulation);
    /// After each step.
    void follow(const Simulation& simulation);
    /// A request took effect at the present boundary.
    void note(const Simulation& simulation, const Request& request);
    /// The present run as it stood at the step nearest to a time, made from the last snapshot before it; what was asked
    /// at or after that step is forgotten. A new run begins. On error nothing has changed: the run, its number and who waits
    /// are what they were.
    Result<void> rewind(Simulation& simulation, double time);

private:
    struct Point
    {
        Snapshot snapshot;
        Tick step = 0;
        double time = 0;  ///< s
        std::size_t bytes = 0;
    };
    struct Asked
    {
        Request request;
        Tick step = 0;
        std::size_t bytes = 0;
    };
    struct Present;
    void add_point(const Simulation& simulation);
    void thin();
    void give_up_earliest();
    Result<void> go_forward(Simulation& simulation, const std::vector<Asked>& asked, double time);

    HistoryOptions options_;
    double interval_ = 0;  ///< s: the present one
    std::vector<Point> checkpoints_;
    std::deque<Asked> asked_;  ///< in the order of steps
    std::size_t bytes_ = 0, asked_bytes_ = 0;
    double next_ = 0;  ///< s
    std::map<std::string, Named> named_;
    bool is_rewinding_ = false;
};

}  // namespace plab::simulation
