/// How often a topic may be written: at most so many times a second, and at most so many bytes.
#pragma once

#include <algorithm>
#include <chrono>

namespace plab::ros
{

class Budget
{
public:
    using Clock = std::chrono::steady_clock;
    /// Of one topic. 10,000 transforms have 1.2 MB: they come 14 times a second.
    static constexpr double kBytesPerSecond = 16.0 * (1 << 20);

    explicit Budget(double per_second) : interval_(1 / per_second) {}

    bool is_due(Clock::time_point now) const { return now >= next_; }
    Clock::time_point next() const { return next_; }
    void spend(Clock::time_point now, std::size_t bytes)
    {
        const double wait = std::max(interval_, static_cast<double>(bytes) / kBytesPerSecond);
        const auto duration = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wait));
        // The grid is kept if it is only a little late, so that the rate is reached on average.
        next_ = now - next_ < duration ? next_ + duration : now + duration;
    }

private:
    double interval_;
    Clock::time_point next_{};
};

}  // namespace plab::ros
