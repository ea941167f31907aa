#include "control/recording/recorder/pending_disposals.h"

#include <algorithm>

namespace plab::recorder
{

std::vector<Disposal> PendingDisposals::take_first(std::size_t count)
{
    std::vector<Disposal> out;
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(count);
    for (auto w = waiting_.begin(); w != end; ++w) out.push_back(std::move(w->disposal));
    waiting_.erase(waiting_.begin(), end);
    return out;
}

std::vector<Disposal> PendingDisposals::take(Clock::time_point now)
{
    const auto later = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& w) { return w.due > now; });
    return take_first(static_cast<std::size_t>(later - waiting_.begin()));
}

std::vector<Disposal> PendingDisposals::take_before_return(const std::string& topic, const std::string& key)
{
    const auto is_it = [&](const Waiting& w) { return w.disposal.topic == topic && w.disposal.key == key; };
    const auto last = std::find_if(waiting_.rbegin(), waiting_.rend(), is_it).base();
    return take_first(static_cast<std::size_t>(last - waiting_.begin()));
}

}  // namespace plab::recorder
