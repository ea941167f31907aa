/// Limits log lines that another process causes: a number per second, the rest are only counted.
#pragma once

#include <chrono>
#include <cstdint>
#include <utility>

namespace plab::bus
{

class LogLimit
{
public:
    using Clock = std::chrono::steady_clock;
    static constexpr int kMost = 10;

    /// Whether one more line may be logged now.
    bool may(Clock::time_point now)
    {
        if (now - begin_ >= std::chrono::seconds(1)) begin_ = now, said_ = 0;
        if (said_ < kMost) return ++said_, true;
        ++left_out_;
        return false;
    }
    /// The number of suppressed lines since the last call.
    std::uint64_t left_out() { return std::exchange(left_out_, 0); }

private:
    Clock::time_point begin_{};
    int said_ = 0;
    std::uint64_t left_out_ = 0;
};

}  // namespace plab::bus
