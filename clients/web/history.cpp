#include "web/history.h"

#include <nlohmann/json.hpp>

namespace plab::web
{

void History::add_event(Json event)
{
    events_.push_back(std::move(event));
    if (events_.size() > kMostEvents) events_.pop_front();
}

void History::add_metrics(const link::Metrics& m)
{
    if (m.run != run_) metrics_.clear();
    run_ = m.run;
    // After a rewind time comes again.
    while (!metrics_.empty() && metrics_.back().front().get<double>() >= m.time) metrics_.pop_back();
    metrics_.push_back({m.time, m.ledger.kinetic, m.ledger.stored, m.ledger.work, m.ledger.of_requests, m.ledger.unexplained, m.step_ns,
                        m.real_time_factor});
    if (metrics_.size() > kMostMetrics) metrics_.pop_front();
}

void History::clear() { events_.clear(), metrics_.clear(); }

Json History::message() const { return {{"type", "history"}, {"events", events_}, {"metrics", metrics_}}; }

}  // namespace plab::web
