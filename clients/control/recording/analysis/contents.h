/// What a recording is about, as collected from its messages: its runs, its components, and the exchanges of algorithms.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/recording/analysis/stream.h"

namespace plab::analysis
{

/// The position that a message contains; empty if it contains none.
struct RunPosition
{
    std::uint64_t run = 0;
    std::optional<std::int64_t> step;
    std::optional<double> time;  ///< s, simulated
};
/// Empty: the message does not concern a run (types, requests).
std::optional<RunPosition> run_position_of(const Entry& entry);

/// A load, a reset or a restored snapshot begins a new one. Its number is the server's.
struct Run
{
    std::uint64_t number = 0;
    std::string cause;        ///< request that began it: "reset", "load FILE" ..; "" for the first, or if unknown
    std::uint64_t begin = 0;  ///< log_time of the first and the last message
    std::uint64_t end = 0;
    std::int64_t first_step = 0;
    std::int64_t last_step = 0;
    double first_time = 0;  ///< s, simulated
    double last_time = 0;
    bool has_steps = false;  ///< the four fields above are known
};

class Runs
{
public:
    void note(const Entry& entry);
    /// In the order in which they began.
    const std::vector<Run>& all() const { return runs_; }
    /// Counts from 0; empty for a run that was not noted.
    std::optional<std::size_t> index_of(std::uint64_t number) const;

private:
    Run& at(std::uint64_t number, std::uint64_t log_time);

    std::vector<Run> runs_;
};

struct Thing
{
    std::string id;
    bool is_shaft = false;
    std::string motion;
};

/// An interaction whose algorithm changed at `step`.
struct Change
{
    std::uint64_t run = 0;
    std::int64_t step = 0;
    std::uint64_t log_time = 0;
    std::string component, from, to;
};

/// The components: objects by the handles that frames use, interactions and their algorithms.
class Things
{
public:
    void note(const Entry& entry);

    /// Its id; "#7" if the recording does not contain it.
    std::string name_of(std::uint64_t run, std::uint32_t handle) const;
    /// Null if the recording does not contain it.
    const Thing* find(std::uint64_t run, std::uint32_t handle) const;
    /// Empty: that run has no such object. "#7" is the one whose handle is 7.
    std::optional<std::uint32_t> handle_of(std::uint64_t run, const std::string& id) const;
    bool has_objects() const { return !objects_.empty(); }
    bool is_shaft(const std::string& id) const;
    /// Ids of all objects, of any run, sorted.
    std::vector<std::string> objects() const;
    /// Ids of all interactions, of any run, sorted.
    std::vector<std::string> interactions() const;
    /// In the order of the recording.
    const std::vector<Change>& changes() const { return changes_; }

private:
    struct Algorithm
    {
        std::uint64_t run = 0;
        std::string type;
    };
    void note(const plab_v2_Interaction& interaction, std::uint64_t log_time);

    std::map<std::pair<std::uint64_t, std::uint32_t>, Thing> objects_;  ///< by run and handle
    std::map<std::string, Algorithm> algorithms_;                       ///< newest, by interaction
    std::vector<Change> changes_;
};

struct Swap
{
    std::uint64_t run = 0;
    std::int64_t step = 0;       ///< took effect before this one
    std::optional<double> time;  ///< s, simulated; unknown if it comes from the catalogue
    std::uint64_t log_time = 0;
    std::string component;
    std::string from;  ///< "" if the recording does not contain it
    std::string to;
    std::string origin;  ///< "client", "command line"; "" if there is no journal
};

/// Exchanges of algorithms: from the journal, or from the catalogue if no journal was recorded.
class Swaps
{
public:
    /// Of the journal's entries.
    void note(const Entry& entry);
    /// Adds what the catalogue knows: the former algorithms; without a journal, its changes.
    std::vector<Swap> all(const Things& things) const;

private:
    std::vector<Swap> swaps_;
    bool has_journal_ = false;
};

}  // namespace plab::analysis
