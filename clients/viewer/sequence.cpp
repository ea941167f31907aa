#include "viewer/sequence.h"

#include <algorithm>
#include <cmath>

namespace plab::view
{

void Sequence::begin(const State& first)
{
    ++runs_;
    const double done = static_cast<double>(next_) / plan_.per_second;
    origin_ = runs_ == 1 ? plan_.origin.value_or(first.time) : first.time - done;
    if (plan_.duration && !total_) total_ = static_cast<std::uint64_t>(std::max(1.0, std::round(*plan_.duration * plan_.per_second)));
    // A run that starts after `until` has no frames left.
    if (plan_.until)
        total_ = static_cast<std::uint64_t>(std::max(0.0, std::floor((*plan_.until + kSameTime - origin_) * plan_.per_second) + 1));
}

Result<void> Sequence::advance(Moment&& moment, const Draw& draw)
{
    const State& now = moment.state;
    if (!before_ || before_->state.run != now.run) begin(now), before_.reset();
    for (; !done() && time_of(next_) <= now.time + kSameTime; ++next_)
    {
        const double time = time_of(next_);
        const bool is_now = time >= now.time - kSameTime;
        if (!before_ && !is_now)
        {
            ++missing_;
            continue;
        }
        if (!is_now) widest_gap_ = std::max(widest_gap_, now.time - before_->state.time);
        auto drawn = is_now ? draw(next_, moment) : draw(next_, {interpolate(before_->state, now, time), before_->scene});
        if (!drawn) return drawn;
    }
    before_ = std::move(moment);
    return {};
}

}  // namespace plab::view
