#include "simulation/snapshot/history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/names.h"
#include "model/numbers.h"

namespace plab::simulation
{

std::size_t bytes_of(const Snapshot& snapshot)
{
    if (!snapshot) return 0;
    const SnapshotContent& s = *snapshot;
    const auto pairs = [](const auto& p) { return p.heads.size() * sizeof p.heads[0] + p.points.size() * sizeof p.points[0]; };
    constexpr std::size_t kBody = 600, kShaft = 120;  // sum over all columns
    return sizeof s + s.world.cells.size() + s.world.bodies.size() * kBody + s.world.shafts.size() * kShaft + pairs(s.contacts.pairs) +
           pairs(s.contacts.parked) + pairs(s.contacts.force_pairs) + pairs(s.contacts.parked_force_pairs) +
           s.ledger.work.size() * sizeof(double);
}

namespace
{

/// Approximate memory of a request, from its texts and the parts of blueprints.
std::size_t bytes_of(const Request& request)
{
    constexpr std::size_t kEachComponent = 1024, kEachValue = 128;
    std::size_t out = sizeof request;
    for (const Operation& op : request.operations)
    {
        out += sizeof op;
        if (const auto* add = std::get_if<AddOperation>(&op)) out += add->fragment.components.size() * kEachComponent;
        if (const auto* add = std::get_if<AddBlueprintOperation>(&op)) out += add->blueprint->components.size() * kEachComponent;
        if (const auto* swap = std::get_if<SwapOperation>(&op)) out += swap->values.size() * kEachValue;
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
        return reason("there are " + std::to_string(named_.size()) + " snapshots already, which is the limit: forget one first");
    if (all > options_.most_named_bytes)
        return reason("snapshots would take " + std::to_string(all >> 20) + " MB, more than the " +
                      std::to_string(options_.most_named_bytes >> 20) + " MB that are allowed: forget one first");
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

void History::begin(const Run& run)
{
    if (is_rewinding_) return;
    checkpoints_.clear(), asked_.clear();
    bytes_ = asked_bytes_ = 0, interval_ = options_.interval;
    if (options_.interval > 0) add_point(run);
}

void History::follow(const Run& run)
{
    if (options_.interval <= 0 || is_rewinding_ || run.clock.time() < next_) return;
    add_point(run);
}

void History::note(const Run& run, const Request& request)
{
    if (options_.interval <= 0 || is_rewinding_) return;
    // Pause and rate are not replayed: those of the present stay.
    if (!affects_the_run(request)) return;
    if (begins_a_run(request.operations.front())) return;  // begin() is called for these
    Asked asked{request, run.clock.tick, bytes_of(request)};
    asked.request.at.reset(), asked.request.revision.reset();
    // What was prepared for it fits no later scene and would keep a copy of the whole scene alive.
    for (Operation& op : asked.request.operations)
        if (auto* add = std::get_if<AddBlueprintOperation>(&op)) add->prepared.reset();
    // It took effect, whatever the result of its trial was. That result may have depended on the clock, so there is no trial in the
    // replay.
    asked.request.trial.budget = TrialChoice::Budget::None;
    asked_bytes_ += asked.bytes;
    asked_.push_back(std::move(asked));
    // Too many requests since the last checkpoint: make another one after the next step, which allows dropping the ones before it.
    if (asked_bytes_ > options_.most_asked_bytes) next_ = run.clock.time();
}

void History::add_point(const Run& run)
{
    Point point{simulation::capture(run), run.clock.tick, run.clock.time(), 0};
    point.bytes = bytes_of(point.snapshot);
    bytes_ += point.bytes, next_ = point.time + interval_;
    checkpoints_.push_back(std::move(point));
    while (bytes_ > options_.most_bytes && checkpoints_.size() > 2) thin();
    give_up_earliest();
}

/// All requests since the first checkpoint are needed to reproduce what lies between the checkpoints. If they take too much memory, the
/// beginning of the run is dropped.
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

/// Drops every second checkpoint. The first one stays, so the whole run remains reachable with more steps in between.
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

Result<History::RewindPlan> History::plan_rewind(const Run& run, double time) const
{
    if (options_.interval <= 0) return reason("no history is kept: start plabd with --history SECONDS");
    const double half = 0.5 * run.clock.dt.seconds, now = run.clock.time();
    if (!(time <= now + half))
        return reason("t = " + model::format_real(time) + " s is in the future: the run is at " + model::format_real(now) + " s");
    if (!(time >= earliest() - half))
        return reason("t = " + model::format_real(time) +
                      " s is before the earliest kept state of this run, t = " + model::format_real(earliest()) + " s");
    const auto after = std::find_if(checkpoints_.begin(), checkpoints_.end(), [&](const Point& p) { return p.time > time + half; });
    const Point& from = *(after - 1);
    RewindPlan out{from.snapshot, {}};
    for (const Asked& a : asked_)
        if (a.step >= from.step) out.requests.push_back(a);
    return out;
}

void History::cut_after(Tick step)
{
    std::erase_if(checkpoints_, [&](const Point& p) { return p.step > step; });
    std::erase_if(asked_, [&](const Asked& a) { return a.step >= step; });
    bytes_ = asked_bytes_ = 0;
    for (const Point& p : checkpoints_) bytes_ += p.bytes;
    for (const Asked& a : asked_) asked_bytes_ += a.bytes;
    next_ = checkpoints_.back().time + interval_;
}

}  // namespace plab::simulation
