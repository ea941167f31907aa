/// Keeps simulated time in step with real time, without drift.
#pragma once

#include <chrono>
#include <cstdint>

namespace plab::daemon
{

/// The time of a step is computed from an anchor, never from the previous step. If the simulation is too slow, the anchor moves
/// (the pacer slips) instead of catching up, so no backlog grows; slipped() returns the lost time.
class Pacer
{
public:
    using Clock = std::chrono::steady_clock;

    /// When the step that ends at simulated time `next` is due, if asked at `now`. `rate`: 0 means at once.
    Clock::time_point due(double next, double rate, std::uint64_t run, Clock::time_point now);
    /// The clock was stopped (a pause): the real time that passed meanwhile does not count.
    void stand_still() { anchored_ = false; }

    /// Simulated time lost since the start, s.
    double slipped() const { return slipped_; }
    /// Whether it slipped within the last second before `now`.
    bool slipping(Clock::time_point now) const { return slipped_ > 0 && now - last_slip_ < std::chrono::seconds(1); }

private:
    bool anchored_ = false;
    Clock::time_point anchor_;
    double anchor_time_ = 0;  ///< simulated time at the anchor, s
    double rate_ = 0;
    std::uint64_t run_ = 0;
    double slipped_ = 0;
    Clock::time_point last_slip_;
};

/// Real-time factor over the last second.
class RateMeter
{
public:
    using Clock = std::chrono::steady_clock;
    /// Simulated time at `now`; a new run or a pause restarts the measurement.
    void sample(double time, std::uint64_t run, Clock::time_point now);
    double factor() const { return factor_; }

private:
    bool begun_ = false;
    Clock::time_point begin_;
    double begin_time_ = 0;
    std::uint64_t run_ = 0;
    double factor_ = 0;
};

}  // namespace plab::daemon
