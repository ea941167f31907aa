#include "simulation/snapshot/history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/names.h"
#include "model/numbers.h"
#include "simulation/simulation.h"
#include "simulation/watch/divergence_watch.h"

namespace plab::simulation
{

/// The present run, set aside as it is while an earlier state of it is made again. A snapshot would not do: a restored one
/// is a run of its own, with its own number, and what waited in the present one would be refused.
struct History::Present
{
    explicit Present(Simulation& s)
        : live{std::move(s.world_), std::move(s.stepper_)},
          watch(std::exchange(s.watch_, std::make_unique<DivergenceWatch>())),
          loaded(s.loaded_),
          clock{s.tick_, s.dt_, s.base_tick_, s.base_time_, s.paused_, s.steps_left_, s.rate_, 0, 0, 0},
          kinetic_at_start(s.kinetic_at_start_),
          run(s.run_),
          revision(s.revision_),
          requests(s.requests_),
          changes(s.changes_),
          events(s.events_),
          changed_by_scripts(s.changed_by_scripts_)
    {
    }
    void put_back(Simulation& s)
    {
        s.stepper_ = std::move(live.stepper), s.world_ = std::move(live.world), s.watch_ = std::move(watch);
        s.loaded_ = std::move(loaded);
        s.tick_ = clock.tick, s.dt_ = clock.dt, s.base_tick_ = clock.base_tick, s.base_time_ = clock.base_time;
        s.paused_ = clock.paused, s.steps_left_ = clock.steps_left, s.rate_ = clock.rate;
        s.kinetic_at_start_ = kinetic_at_start, s.run_ = run, s.revision_ = revision;
        s.requests_ = std::move(requests), s.changes_ = std::move(changes), s.events_ = std::move(events);
        s.changed_by_scripts_ = std::move(changed_by_scripts);
    }

    Simulation::Live live;
    std::unique_ptr<DivergenceWatch> watch;
    std::shared_ptr<const model::SceneSpec> loaded;
    ClockImage clock;  ///< but for the step before, which the stepper knows
    double kinetic_at_start = 0;
    std::uint64_t run = 0, revision = 0;
    std::deque<Simulation::Waiting> requests;
    Changes changes;
    std::vector<Event> events;
    std::set<std::uint32_t> changed_by_scripts;
};

std::size_t bytes_of(const Snapshot& snapshot)
{
    if (!snapshot) return 0;
    const SnapshotContent& s = *snapshot;
    const auto pairs = [](const auto& p) { return p.heads.size() * sizeof p.heads[0] + p.points.size() * sizeof p.points[0]; };
    constexpr std::size_t kBody = 600, kShaft = 120;  // of all columns
    return sizeof s + s.world.cells.size() + s.world.bodies.size() * kBody + s.world.shafts.size() * kShaft + pairs(s.contacts.pairs) +
           pairs(s.contacts.parked) + pairs(s.contacts.force_pairs) + pairs(s.contacts.parked_force_pairs) +
           s.ledger.work.size() * sizeof(double);
}

namespace
{

/// About what a request holds in memory: texts and blueprints by their parts.
std::size_t bytes_of(const Request& request)
{
    constexpr std::size_t kComponent = 1024, kValue = 128;
    std::size_t out = sizeof request;
    for (const Operation& op : request.operations)
    {
        out += sizeof op;
        if (const auto* add = std::get_if<AddOperation>(&op)) out += add->fragment.components.size() * kComponent;
        if (const auto* add = std::get_if<AddBlueprintOperation>(&op)) out += add->blueprint.components.size() * kComponent;
        if (const auto* swap = std::get_if<SwapOperation>(&op)) out += swap->values.size() * kValue;
        if (const auto* set = std::get_if<SetOperation>(&op))
            if (const auto* text = std::get_if<std::string>(&set->value)) out += text->size();
    }
    return out;
}

}  // namespace

void History::configure(const HistoryOptions& options) { options_ = options, interval_ = options.interval; }

Result<void> History::keep(const std::string& name, const Snapshot& snapshot)
{
    if (name.empty()) return reason("a snapshot needs a name");
    const std::size_t bytes = bytes_of(snapshot);
    std::size_t all = bytes;
    for (const auto& [other, kept] : named_) all += other == name ? 0 : kept.bytes;
    if (!named_.contains(name) && named_.size() >= options_.most_named)
        return reason("there are " + std::to_string(named_.size()) + " snapshots already, no more are kept: forget one");
    if (all > options_.most_named_bytes)
        return reason("snapshots would take " + std::to_string(all >> 20) + " MB, more than the " +
                      std::to_string(options_.most_named_bytes >> 20) + " MB that are kept: forget one");
    named_[name] = {snapshot, bytes};
    return {};
}

Result<Snapshot> History::find(const std::string& name) const
{
    if (const auto found = named_.find(name); found != named_.end()) return found->second.snapshot;
    std::vector<std::string> known;
    for (const auto& [other, kept] : named_) known.push_back(other);
    return reason("no snapshot has the name '" + name + "'" + model::did_you_mean(name, known));
}

Result<void> History::forget(const std::string& name)
{
    if (auto found = find(name); !found) return found.errors();
    named_.erase(name);
    return {};
}

void History::begin(const Simulation& simulation)
{
    if (is_rewinding_) return;
    checkpoints_.clear(), asked_.clear();
    bytes_ = asked_bytes_ = 0, interval_ = options_.interval;
    if (options_.interval > 0) add_point(simulation);
}

void History::follow(const Simulation& simulation)
{
    if (options_.interval <= 0 || is_rewinding_ || simulation.time() < next_) return;
    add_point(simulation);
}

void History::note(const Simulation& simulation, const Request& request)
{
    if (options_.interval <= 0 || is_rewinding_) return;
    // Pause and rate are the present's: they are not asked again.
    if (!affects_the_run(request)) return;
    if (begins_a_run(request.operations.front())) return;  // begin() was told of it
    Asked asked{request, simulation.tick(), bytes_of(request)};
    asked.request.at.reset(), asked.request.revision.reset();
    // It took effect, whatever its trial came to, which the clock may have decided.
    asked.request.trial.budget = TrialChoice::Budget::None;
    asked_bytes_ += asked.bytes;
    asked_.push_back(std::move(asked));
    // Too much since the last point: one more follows at the next step, and lets go what was before it.
    if (asked_bytes_ > options_.most_asked_bytes) next_ = simulation.time();
}

void History::add_point(const Simulation& simulation)
{
    Point point{simulation.capture(), simulation.tick(), simulation.time(), 0};
    point.bytes = bytes_of(point.snapshot);
    bytes_ += point.bytes, next_ = point.time + interval_;
    checkpoints_.push_back(std::move(point));
    while (bytes_ > options_.most_bytes && checkpoints_.size() > 2) thin();
    give_up_earliest();
}

/// Requests since the first point are all needed to make again what lies between the points: who asks much and for long gives up
/// the beginning of the run.
void History::give_up_earliest()
{
    std::size_t points = 0, requests = 0;
    while (asked_bytes_ > options_.most_asked_bytes && points + 1 < checkpoints_.size())
    {
        bytes_ -= checkpoints_[points++].bytes;
        for (; requests < asked_.size() && asked_[requests].step < checkpoints_[points].step; ++requests)
            asked_bytes_ -= asked_[requests].bytes;
    }
    checkpoints_.erase(checkpoints_.begin(), checkpoints_.begin() + static_cast<std::ptrdiff_t>(points));
    asked_.erase(asked_.begin(), asked_.begin() + static_cast<std::ptrdiff_t>(requests));
}

/// The first one stays: all that is kept of the run can be made again, with more steps in between.
void History::thin()
{
    std::vector<Point> kept;
    bytes_ = 0;
    for (std::size_t i = 0; i < checkpoints_.size(); i += 2)
    {
        bytes_ += checkpoints_[i].bytes;
        kept.push_back(std::move(checkpoints_[i]));
    }
    checkpoints_ = std::move(kept);
    interval_ *= 2;
    next_ = checkpoints_.back().time + interval_;
}

Result<void> History::rewind(Simulation& simulation, double time)
{
    if (options_.interval <= 0) return reason("no history is kept: start plabd with --history SECONDS");
    const double half = 0.5 * simulation.dt();
    if (!(time <= simulation.time() + half))
        return reason("t = " + model::format_real(time) + " s is ahead: the run is at " + model::format_real(simulation.time()) + " s");
    if (!(time >= earliest() - half))
        return reason("t = " + model::format_real(time) + " s is before what is kept of this run, which begins at " +
                      model::format_real(earliest()) + " s");
    const auto after = std::find_if(checkpoints_.begin(), checkpoints_.end(), [&](const Point& p) { return p.time > time + half; });
    const Point from = *(after - 1);
    std::vector<Asked> again;
    for (const Asked& a : asked_)
        if (a.step >= from.step) again.push_back(a);
    Present present(simulation);
    is_rewinding_ = true;
    auto done = simulation.restore(from.snapshot);
    if (done) done = go_forward(simulation, again, time);
    if (!done) present.put_back(simulation);
    is_rewinding_ = false;
    if (!done) return done;
    const Tick step = simulation.tick();
    std::erase_if(checkpoints_, [&](const Point& p) { return p.step > step; });
    std::erase_if(asked_, [&](const Asked& a) { return a.step >= step; });
    bytes_ = asked_bytes_ = 0;
    for (const Point& p : checkpoints_) bytes_ += p.bytes;
    for (const Asked& a : asked_) asked_bytes_ += a.bytes;
    next_ = checkpoints_.back().time + interval_;
    return {};
}

Result<void> History::go_forward(Simulation& simulation, const std::vector<Asked>& asked, double time)
{
    std::size_t next = 0;
    while (simulation.time() < time - 0.5 * simulation.dt())
    {
        for (; next < asked.size() && asked[next].step == simulation.tick(); ++next)
            if (const Reply reply = simulation.carry_out_now(asked[next].request); !reply.done)
                return reason("a request of step " + std::to_string(asked[next].step) +
                              " cannot be carried out again: " + (reply.errors.empty() ? std::string() : reply.errors.front().text()));
        if (!simulation.step_once())
            return reason("the server is to end: the way back was given up at step " + std::to_string(simulation.tick()));
    }
    // Whoever waited for a step that was made again was among those that were asked again.
    simulation.forget_late_requests();
    return {};
}

}  // namespace plab::simulation
