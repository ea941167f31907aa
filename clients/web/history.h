/// What happened before a page was opened: the newest events and metrics, bounded.
#pragma once

#include <deque>

#include "web/translate.h"

namespace plab::web
{

class History
{
public:
    static constexpr std::size_t kMostEvents = 500;
    static constexpr std::size_t kMostMetrics = 1200;  ///< five minutes

    void add_event(Json event);
    void add_metrics(const link::Metrics& metrics);
    /// Another server, or another run: what was before is no past of it.
    void clear();

    /// {"type": "history", "events": [...], "metrics": [[time, kinetic, stored, work, of_requests, unexplained, step_ns, rate], ...]}
    Json message() const;

private:
    std::deque<Json> events_, metrics_;
    std::uint64_t run_ = 0;
};

}  // namespace plab::web
