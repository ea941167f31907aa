/// The runs of a recording: a load, a reset or a restored snapshot begins a new one. Its number is the server's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/recordings/stream.h"

namespace plab::recordings
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

}  // namespace plab::recordings
