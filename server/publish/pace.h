/// Decides when something is due, by real time.
#pragma once

#include <chrono>
#include <cstdint>

namespace plab::publish
{

using Nanoseconds = std::int64_t;

inline Nanoseconds monotonic_now()
{
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A grid in time. Steps come at arbitrary times, yet the average rate is kept.
class Pace
{
public:
    /// 0: always due.
    explicit Pace(double per_second) : period_(per_second > 0 ? static_cast<Nanoseconds>(1e9 / per_second) : 0) {}

    /// Whether it is due now; if so, the next time is one period later.
    bool due(Nanoseconds now)
    {
        // Accept a step that ends a little early: waiting for the next one would make intervals uneven.
        if (now < next_ - period_ / 8) return false;
        next_ += period_;
        if (next_ <= now) next_ = now + period_;
        return true;
    }
    /// It was done now, out of turn.
    void restart(Nanoseconds now) { next_ = now + period_; }

private:
    Nanoseconds period_;
    Nanoseconds next_ = 0;
};

}  // namespace plab::publish
