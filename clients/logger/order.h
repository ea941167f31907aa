/// Sorts lines of several topics by the time of their events, although topics arrive independently.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace plab::logger
{

struct Line
{
    std::uint64_t run = 0;
    std::int64_t step = 0;
    bool counts = true;  ///< counts for -n
    std::string text;
};

/// A line waits for kSettling for earlier ones, because lost samples are retransmitted and come late.
class Order
{
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kSettling{100};

    void add(Line line, Clock::time_point now) { waiting_.push_back({std::move(line), now + kSettling}); }

    /// In order, the lines that have waited long enough at `now`, and all earlier ones. Lines of one step keep the order in
    /// which they were added.
    std::vector<Line> take(Clock::time_point now)
    {
        std::stable_sort(waiting_.begin(), waiting_.end(), happened_before);
        const auto end = std::find_if(waiting_.rbegin(), waiting_.rend(), [&](const Waiting& w) { return w.due <= now; }).base();
        std::vector<Line> out;
        for (auto w = waiting_.begin(); w != end; ++w) out.push_back(std::move(w->line));
        waiting_.erase(waiting_.begin(), end);
        return out;
    }
    std::vector<Line> take_all() { return take(Clock::time_point::max()); }

    /// When take() will return something; `latest` if nothing waits until then.
    Clock::time_point due(Clock::time_point latest) const
    {
        for (const Waiting& w : waiting_) latest = std::min(latest, w.due);
        return latest;
    }

private:
    struct Waiting
    {
        Line line;
        Clock::time_point due;
    };
    static bool happened_before(const Waiting& a, const Waiting& b)
    {
        return a.line.run != b.line.run ? a.line.run < b.line.run : a.line.step < b.line.step;
    }

    std::vector<Waiting> waiting_;
};

}  // namespace plab::logger
