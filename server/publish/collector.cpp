#include "publish/collector.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "publish/states.h"

namespace plab::publish
{
namespace
{

constexpr Nanoseconds kSecond = 1'000'000'000;
/// Between samples of metrics that requests ask for: a client that sends a thousand a second does not get as many.
constexpr Nanoseconds kShortestSample = 50'000'000;

/// What makes a status news.
auto matter_of(const Status& s)
{
    return std::tie(s.scene_file, s.run, s.revision, s.dt, s.paused, s.rate_asked, s.slipping, s.threads, s.requests_done,
                    s.requests_refused);
}

}  // namespace

Collector::Collector(const CollectorOptions& options, std::vector<model::TypeSummary> types)
    : options_(options),
      catalogue_(std::move(types)),
      states_(options.states_per_second),
      metrics_(options.metrics_per_second),
      scripted_(options.metrics_per_second)
{
}

void Collector::attach(Observer& observer)
{
    watchers_.emplace_back().observer = &observer;
    told_at_ = 0;
}

/// Whether somebody watches the stream who has not seen anything of it yet.
bool Collector::fresh(const Observer& observer, Stream stream, Wish& wish)
{
    const Wish now{observer.wants(stream), observer.joins(stream)};
    const bool out = now.wanted && (!wish.wanted || now.joins != wish.joins);
    wish = now;
    return out;
}

void Collector::collect(const simulation::Simulation& s, const simulation::Changes& changes, bool stepped)
{
    // Events are numbered whether anybody reads them or not.
    const Counts counts = stepped ? count(s.events()) : Counts{};
    if (!watchers_.empty())
    {
        const Nanoseconds now = monotonic_now();
        const bool requested = !stepped || changes.everything || !changes.touched.empty();
        catalogue_.follow(s, changes, stepped ? s.tick() - 1 : s.tick());
        if (scripted_.due(now)) catalogue_.release_scripted(s);
        tell_catalogue(s, now);
        // What stands still must be seen as it stands, however soon after the last frame.
        tell_states(s, now, s.paused() ? When::Now : When::InTurn);
        tell_events(s, counts);
        tell_metrics(s, now, requested ? When::Now : When::InTurn);
    }
    next_collision_ += counts.collisions, next_event_ += counts.others;
}

void Collector::idle(const simulation::Simulation& s)
{
    if (watchers_.empty()) return;
    const Nanoseconds now = monotonic_now();
    tell_catalogue(s, now);
    tell_states(s, now, When::ForNewcomers);
    tell_metrics(s, now, When::ForNewcomers);
}

void Collector::tell_catalogue(const simulation::Simulation& s, Nanoseconds now)
{
    const bool news = catalogue_.news();
    for (Watcher& w : watchers_)
    {
        w.needs_everything = w.needs_everything || catalogue_.all_new();
        if (!w.needs_everything && news)
            w.needs_everything = !w.observer->catalogue(catalogue_.changes(s));
        else if (w.needs_everything && (catalogue_.all_new() || w.retry.due(now)))
            w.needs_everything = !w.observer->catalogue(catalogue_.everything(s));
    }
    catalogue_.clear();
}

void Collector::tell_states(const simulation::Simulation& s, Nanoseconds now, When when)
{
    bool wanted = false, due = when == When::Now;
    for (Watcher& w : watchers_)
    {
        due = fresh(*w.observer, Stream::States, w.states) || due;
        wanted = wanted || w.states.wanted;
    }
    if (!wanted) return;
    due = (when == When::InTurn && states_.due(now)) || due;
    if (!due) return;
    ++frames_;
    for (const Watcher& w : watchers_)
    {
        if (!w.states.wanted) continue;
        Frame& frame = w.observer->begin_frame();
        fill_frame(s, catalogue_.roster(), frame);
        frame.number = frames_;
        w.observer->end_frame();
    }
}

void Collector::tell_events(const simulation::Simulation& s, const Counts& counts)
{
    const Tick step = s.tick() - 1;
    for (const Watcher& w : watchers_)
    {
        if (counts.collisions > 0 && w.observer->wants(Stream::Collisions)) w.observer->collisions(collisions_of(s, step, next_collision_));
        if (counts.others > 0 && w.observer->wants(Stream::Events)) w.observer->events(events_of(s, step, next_event_));
    }
}

void Collector::tell_metrics(const simulation::Simulation& s, Nanoseconds now, When when)
{
    bool wanted = false;
    metrics_asked_ = metrics_asked_ || when == When::Now;
    for (Watcher& w : watchers_)
    {
        metrics_asked_ = fresh(*w.observer, Stream::Metrics, w.metrics) || metrics_asked_;
        wanted = wanted || w.metrics.wanted;
    }
    if (!wanted) metrics_asked_ = false;
    const bool out_of_turn = metrics_asked_ && now - sampled_ >= kShortestSample;
    if (!wanted || !(out_of_turn || (when != When::ForNewcomers && metrics_.due(now)))) return;
    if (out_of_turn) metrics_.restart(now);
    metrics_asked_ = false, sampled_ = now;
    const Metrics metrics = sampler_.sample(s, now);
    for (const Watcher& w : watchers_)
        if (w.metrics.wanted) w.observer->metrics(Metrics(metrics));
}

void Collector::note(const simulation::Simulation& s, EventRecord event)
{
    Batch<EventRecord> batch;
    batch.run = s.run(), batch.first = next_event_++, batch.step = s.tick();
    event.time = s.time();
    batch.entries.push_back(std::move(event));
    for (const Watcher& w : watchers_)
        if (w.observer->wants(Stream::Events)) w.observer->events(Batch<EventRecord>(batch));
}

void Collector::status(const Status& status)
{
    const Nanoseconds now = monotonic_now();
    if (told_at_ != 0 && now - told_at_ < kSecond && matter_of(status) == matter_of(told_)) return;
    told_ = status, told_at_ = now;
    told_.states_per_second = options_.states_per_second;
    told_.last_event = last_event(), told_.last_collision = last_collision();
    for (const Watcher& w : watchers_) w.observer->status(told_);
}

}  // namespace plab::publish
