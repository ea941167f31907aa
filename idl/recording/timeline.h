/// The time line of a recording: simulated time, which continues where a new run begins at zero.
/// A run is placed at the log_time that the recording had reached when the run was first seen. So log_time never jumps back at
/// a reset, a load or a rewind, and a second in a recording is a simulated second. Samples can arrive out of order: what a run
/// reports for a time before it was first seen, or after the next one began, is placed at that boundary, so that runs do not
/// overlap.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>

namespace plab::recording
{

class Timeline
{
public:
    /// ns. `seconds`: simulated time in the run. A run may begin at any time (a rewound one does).
    std::uint64_t at(std::uint64_t run, double seconds)
    {
        const std::int64_t time = nanoseconds(seconds);
        const auto begin = static_cast<std::int64_t>(now_);
        const auto known = runs_.try_emplace(run, Run{begin - time, begin}).first;
        const auto next = std::next(known);
        std::int64_t log_time = std::max(known->second.zero + time, known->second.begin);
        if (next != runs_.end()) log_time = std::min(log_time, next->second.begin);
        const auto out = static_cast<std::uint64_t>(log_time);
        now_ = std::max(now_, out);
        return out;
    }
    /// ns: the latest time so far, for samples without a time of their own.
    std::uint64_t now() const { return now_; }
    /// Simulated seconds of a run at a log_time; 0 for a run that was never seen.
    double seconds(std::uint64_t run, std::uint64_t log_time) const
    {
        const auto known = runs_.find(run);
        if (known == runs_.end()) return 0;
        return static_cast<double>(static_cast<std::int64_t>(log_time) - known->second.zero) * 1e-9;
    }

private:
    /// Far beyond any run: 200 years.
    static constexpr double kMost = 6e9;
    static std::int64_t nanoseconds(double seconds)
    {
        if (!(seconds > 0)) return 0;
        return std::llround(std::fmin(seconds, kMost) * 1e9);
    }

    struct Run
    {
        std::int64_t zero = 0;   ///< ns: log_time at which its own time was zero
        std::int64_t begin = 0;  ///< ns: log_time at which it was first seen
    };
    std::map<std::uint64_t, Run> runs_;
    std::uint64_t now_ = 0;
};

}  // namespace plab::recording
