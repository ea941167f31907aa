#include "control/recording/player/pace.h"

#include <algorithm>
#include <cmath>

namespace plab::player
{

Pace::Pace(const Span& span, double rate, bool paused, Clock::time_point now)
    : span_(span), rate_(std::clamp(rate, kSlowest, kFastest)), is_paused_(paused), base_(span.from), base_time_(now)
{
}

std::uint64_t Pace::position(Clock::time_point now) const
{
    if (is_paused_ || now <= base_time_) return base_;
    const double gone = std::chrono::duration<double, std::nano>(now - base_time_).count() * rate_;
    const auto left = static_cast<double>(span_.to - base_);
    return gone >= left ? span_.to : base_ + static_cast<std::uint64_t>(std::llround(gone));
}

std::optional<Pace::Clock::time_point> Pace::when(std::uint64_t time) const
{
    if (time <= base_) return base_time_;
    if (is_paused_) return {};
    // Rounded up: at that moment the position is not before `time`.
    const double wait = std::ceil(static_cast<double>(time - base_) / rate_);
    constexpr double kLongest = 1e17;  // ns, three years
    return base_time_ + std::chrono::nanoseconds(static_cast<std::int64_t>(std::min(wait, kLongest)) + 1);
}

void Pace::pause(bool paused, Clock::time_point now)
{
    base_ = position(now), base_time_ = now;
    is_paused_ = paused;
}

void Pace::set_rate(double rate, Clock::time_point now)
{
    base_ = position(now), base_time_ = now;
    rate_ = std::clamp(rate, kSlowest, kFastest);
}

void Pace::seek(std::uint64_t time, Clock::time_point now) { base_ = span_.within(time), base_time_ = now; }

}  // namespace plab::player
