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
/// Minimum time between samples of metrics that requests trigger: a client that sends a thousand requests per second does not
/// get as many samples.
constexpr Nanoseconds kShortestSample = 50'000'000;
/// Minimum real time between samples for observers with an interval of simulated time: a run that is faster than real time is
/// not slowed down by its metrics.
constexpr Nanoseconds kShortestOwnSample = 1'000'000;

/// Whether a status differs in anything that must be sent at once.
auto matter_of(const wire::Server& s)
{
    return std::tie(s.scene_file, s.run, s.revision, s.dt, s.paused, s.rate_asked, s.overload, s.threads, s.requests_done,
                    s.requests_refused, s.snapshots, s.recording.file, s.recording.trouble);
}

}  // namespace

Collector::Collector(const CollectorOptions& options, const std::vector<model::TypeSummary>& types)
    : options_(options),
      catalogue_(types),
      sampler_(options.error_share),
      states_(options.states_per_second),
      contacts_(options.states_per_second),
      metrics_(options.metrics_per_second),
      scripted_(options.metrics_per_second),
      snapshots_(options.seconds_between_snapshots > 0 ? 1 / options.seconds_between_snapshots : 0)
{
}

void Collector::attach(Observer& observer)
{
    watchers_.emplace_back().observer = &observer;
    published_at_ = 0;
}

/// Whether a new observer of the stream has not received anything of it yet.
bool Collector::fresh(const Observer& observer, Stream stream, Wish& wish)
{
    const Wish now{observer.wants(stream), observer.joins(stream)};
    const bool out = now.wanted && (!wish.wanted || now.joins != wish.joins);
    wish = now;
    return out;
}

/// Whether something is due by the observer's own interval of simulated time, or, if it has none, by the server's schedule.
bool Collector::in_turn(const Observer& observer, Stream stream, double time, double& next, bool servers_turn)
{
    const std::optional<double> interval = observer.interval(stream);
    if (!interval) return servers_turn;
    // Steps do not fall exactly on the grid: the nearest one is taken.
    if (time < next - 1e-6 * *interval) return false;
    next += *interval;
    if (next <= time) next = time + *interval;
    return true;
}

void Collector::begin_run(const simulation::Simulation& s)
{
    if (s.run() == run_) return;
    run_ = s.run();
    // Simulated time has restarted.
    for (Watcher& w : watchers_) w.next_frame = w.next_contacts = w.next_metrics = s.time();
}

/// Contacts are noted while a step is made, so it has to be known before whether they are due after it.
void Collector::prepare(simulation::Simulation& s)
{
    if (watchers_.empty()) return;
    begin_run(s);
    bool wanted = false, any_due = false;
    for (Watcher& w : watchers_)
    {
        const bool came = fresh(*w.observer, Stream::Contacts, w.contacts);
        w.contacts_due = w.contacts.wanted && (w.contacts_due || came);
        wanted = wanted || w.contacts.wanted;
    }
    // The final state of a paused scene must be sent, however soon after the last sample.
    const bool servers_turn = wanted && (contacts_.due(monotonic_now()) || s.pauses_after_step());
    for (Watcher& w : watchers_)
    {
        if (w.contacts.wanted && in_turn(*w.observer, Stream::Contacts, s.time() + s.dt(), w.next_contacts, servers_turn))
            w.contacts_due = true;
        any_due = any_due || w.contacts_due;
    }
    s.log_contacts(any_due);
}

void Collector::report_contacts(const simulation::Simulation& s)
{
    if (!s.stepper().contact_log().on()) return;
    for (Watcher& w : watchers_)
    {
        if (!std::exchange(w.contacts_due, false)) continue;
        wire::ContactForces& contacts = w.observer->begin_contacts();
        contacts_of_step_.fill(s, contacts);
        contacts.sequence_number = ++w.contact_samples;
        w.observer->end_contacts();
    }
}

void Collector::collect(const simulation::Simulation& s, const simulation::Changes& changes, bool stepped)
{
    // Events are numbered whether or not they are read.
    const Counts counts = stepped ? count(s.events()) : Counts{};
    if (!watchers_.empty())
    {
        const Nanoseconds now = monotonic_now();
        begin_run(s);
        report_moment(s);
        const bool requested = !stepped || changes.everything || !changes.touched.empty();
        catalogue_.follow(s, changes, stepped ? s.tick() - 1 : s.tick());
        if (scripted_.due(now)) catalogue_.release_scripted(s);
        report_catalogue(s, now);
        // The final state of a paused scene must be sent, however soon after the last frame.
        report_states(s, now, s.paused() ? When::Now : When::InTurn);
        report_events(s, counts);
        report_metrics(s, now, requested ? When::Now : When::InTurn);
        if (stepped) report_contacts(s), report_hash(s);
    }
    next_collision_ += counts.collisions, next_event_ += counts.others;
}

void Collector::idle(const simulation::Simulation& s)
{
    if (watchers_.empty()) return;
    const Nanoseconds now = monotonic_now();
    report_moment(s);
    report_catalogue(s, now);
    report_states(s, now, When::ForNewcomers);
    report_metrics(s, now, When::ForNewcomers);
}

void Collector::report_moment(const simulation::Simulation& s)
{
    for (const Watcher& w : watchers_) w.observer->moment(s.run(), s.time());
}

void Collector::report_catalogue(const simulation::Simulation& s, Nanoseconds now)
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

void Collector::report_states(const simulation::Simulation& s, Nanoseconds now, When when)
{
    bool wanted = false, for_all = when == When::Now;
    for (Watcher& w : watchers_)
    {
        for_all = fresh(*w.observer, Stream::States, w.states) || for_all;
        wanted = wanted || w.states.wanted;
    }
    if (!wanted) return;
    const bool servers_turn = when == When::InTurn && states_.due(now);
    for (Watcher& w : watchers_)
    {
        const bool due = for_all || (when == When::InTurn && in_turn(*w.observer, Stream::States, s.time(), w.next_frame, servers_turn));
        if (!w.states.wanted || !due) continue;
        wire::Frame& frame = w.observer->begin_frame();
        fill_frame(s, catalogue_.roster(), frame);
        // Numbered per observer: one that gets every tenth frame has not missed nine.
        frame.sequence_number = ++w.frames;
        w.observer->end_frame();
        // Out of turn: the next one is due one interval from now.
        if (const auto interval = w.observer->interval(Stream::States); for_all && interval) w.next_frame = s.time() + *interval;
    }
}

void Collector::report_hash(const simulation::Simulation& s)
{
    const auto wants = [](const Watcher& w) { return w.observer->wants(Stream::Hashes); };
    if (std::none_of(watchers_.begin(), watchers_.end(), wants)) return;
    const std::uint64_t hash = s.state_hash();
    for (const Watcher& w : watchers_)
        if (wants(w)) w.observer->hash(s.run(), s.tick(), hash);
}

void Collector::journal(wire::Journal entry)
{
    entry.sequence_number = next_journal_++;
    for (const Watcher& w : watchers_)
        if (w.observer->wants(Stream::Journal)) w.observer->journal(wire::Journal(entry));
}

std::optional<const char*> Collector::wants_snapshot(const simulation::Simulation& s)
{
    bool begin = false, periodic = false, wanted = false;
    for (Watcher& w : watchers_)
    {
        begin = fresh(*w.observer, Stream::Snapshots, w.snapshots) || begin;
        wanted = wanted || w.snapshots.wanted;
        begin = begin || (w.snapshots.wanted && w.snapshot_run != s.run());
    }
    if (!wanted) return {};
    const bool servers_turn = snapshots_.due(monotonic_now());
    for (Watcher& w : watchers_)
    {
        if (!w.snapshots.wanted) continue;
        if (std::exchange(w.snapshot_run, s.run()) != s.run()) w.next_snapshot = s.time();
        periodic = in_turn(*w.observer, Stream::Snapshots, s.time(), w.next_snapshot, servers_turn) || periodic;
    }
    if (begin) return "begin";
    if (periodic) return "periodic";
    return {};
}

bool Collector::anybody_reads(Stream stream) const
{
    return std::any_of(watchers_.begin(), watchers_.end(), [&](const Watcher& w) { return w.observer->wants(stream); });
}

void Collector::forces(wire::Forces forces)
{
    forces.sequence_number = next_forces_++;
    for (const Watcher& w : watchers_)
        if (w.observer->wants(Stream::Forces)) w.observer->forces(wire::Forces(forces));
}

void Collector::snapshot(const wire::Snapshot& snapshot)
{
    for (const Watcher& w : watchers_)
        if (w.observer->wants(Stream::Snapshots)) w.observer->snapshot(wire::Snapshot(snapshot));
}

void Collector::report_events(const simulation::Simulation& s, const Counts& counts)
{
    const Tick step = s.tick() - 1;
    for (const Watcher& w : watchers_)
    {
        if (counts.collisions > 0 && w.observer->wants(Stream::Collisions)) w.observer->collisions(collisions_of(s, step, next_collision_));
        if (counts.others > 0 && w.observer->wants(Stream::Events)) w.observer->events(events_of(s, step, next_event_));
    }
}

void Collector::report_metrics(const simulation::Simulation& s, Nanoseconds now, When when)
{
    bool wanted = false, own_turn = false;
    metrics_asked_ = metrics_asked_ || when == When::Now;
    for (Watcher& w : watchers_)
    {
        metrics_asked_ = fresh(*w.observer, Stream::Metrics, w.metrics) || metrics_asked_;
        wanted = wanted || w.metrics.wanted;
        const bool may = w.metrics.wanted && when != When::ForNewcomers && now - sampled_ >= kShortestOwnSample;
        own_turn = (may && in_turn(*w.observer, Stream::Metrics, s.time(), w.next_metrics, false)) || own_turn;
    }
    if (!wanted) metrics_asked_ = false;
    const bool out_of_turn = metrics_asked_ && now - sampled_ >= kShortestSample;
    if (!wanted || !(out_of_turn || own_turn || (when != When::ForNewcomers && metrics_.due(now)))) return;
    if (out_of_turn) metrics_.restart(now);
    if (out_of_turn || !own_turn) metrics_asked_ = false;
    sampled_ = now;
    const wire::Metrics metrics = sampler_.sample(s, now);
    for (const Watcher& w : watchers_)
        if (w.metrics.wanted) w.observer->metrics(wire::Metrics(metrics));
}

void Collector::note(const simulation::Simulation& s, wire::EventInfo event)
{
    wire::Events batch;
    report_moment(s);
    batch.run = s.run(), batch.sequence_number = next_event_++, batch.step = s.tick();
    event.time = s.time();
    batch.entries.push_back(std::move(event));
    for (const Watcher& w : watchers_)
        if (w.observer->wants(Stream::Events)) w.observer->events(wire::Events(batch));
}

void Collector::status(const wire::Server& status)
{
    const Nanoseconds now = monotonic_now();
    if (published_at_ != 0 && now - published_at_ < kSecond && matter_of(status) == matter_of(published_)) return;
    published_ = status, published_at_ = now;
    published_.states_per_second = options_.states_per_second;
    published_.last_event = last_event(), published_.last_collision = last_collision();
    for (const Watcher& w : watchers_) w.observer->status(published_);
}

}  // namespace plab::publish
