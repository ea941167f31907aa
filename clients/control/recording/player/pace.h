/// The position of a playback on the recording's time line, by a clock that the caller reads.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace plab::player
{

/// Part of a time line, ns; both ends are included.
struct Span
{
    std::uint64_t from = 0, to = 0;

    std::uint64_t within(std::uint64_t time) const { return time < from ? from : time > to ? to : time; }
    double seconds() const { return static_cast<double>(to - from) * 1e-9; }
};

class Pace
{
public:
    using Clock = std::chrono::steady_clock;
    static constexpr double kSlowest = 1e-3, kFastest = 1e3;

    /// Starts at span.from. `rate`: seconds of the recording per second of real time, from kSlowest to kFastest.
    Pace(const Span& span, double rate, bool paused, Clock::time_point now);

    /// ns; always within the span.
    std::uint64_t position(Clock::time_point now) const;
    bool at_end(Clock::time_point now) const { return position(now) == span_.to; }
    /// When the playback reaches `time`; empty: it is paused, and `time` is not reached yet.
    std::optional<Clock::time_point> when(std::uint64_t time) const;

    void pause(bool paused, Clock::time_point now);
    void set_rate(double rate, Clock::time_point now);
    /// Moves to the nearest time within the span.
    void seek(std::uint64_t time, Clock::time_point now);

    const Span& span() const { return span_; }
    double rate() const { return rate_; }
    bool is_paused() const { return is_paused_; }

private:
    Span span_;
    double rate_;
    bool is_paused_;
    std::uint64_t base_;  ///< position at base_time_
    Clock::time_point base_time_;
};

}  // namespace plab::player
