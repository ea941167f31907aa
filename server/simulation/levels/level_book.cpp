#include "simulation/levels/level_book.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/text.h"
#include "world/bounding_radius.h"

namespace plab::simulation
{
namespace
{

bool names_objects(const Role& role)
{
    const auto object = [](Facet f) { return f == Facet::Body || f == Facet::Shaft || f == Facet::Quantities; };
    return std::any_of(role.facets.begin(), role.facets.end(), object);
}

bool moves(const world::HostTables& host, Ref r)
{
    if (r.facet == Facet::Body) return host.bodies.motion[r.index] != Motion::Static;
    if (r.facet == Facet::Shaft) return host.shafts.motion[r.index] != Motion::Static;
    return false;
}

std::string text_of(const world::World& world, std::uint32_t component, const char* field)
{
    const Value value = world.get(component, field);
    const auto* text = std::get_if<std::string>(&value);
    return text ? *text : std::string();
}

double real_of(const world::World& world, std::uint32_t component, const char* field)
{
    const Value value = world.get(component, field);
    const auto* real = std::get_if<double>(&value);
    return real ? *real : 0;
}

}  // namespace

LevelBook::LevelBook(world::World& world, Stepper& stepper) : world_(world), stepper_(stepper) {}
LevelBook::~LevelBook() = default;

bool LevelBook::is_governor(std::uint32_t component) const
{
    return std::any_of(governors_.begin(), governors_.end(), [&](const Governor& g) { return g.component == component; });
}

/// Looked up once for all, because a scene may have a solver for each body.
void LevelBook::find_parts()
{
    owner_of_part_.clear();
    for (const std::uint32_t i : governors_.empty() ? std::span<const std::uint32_t>() : world_.in_id_order())
    {
        if (world_.component(i).table == kNoIndex) continue;
        for (const Role& role : world_.table_of(i).schema().roles())
            if (!names_objects(role))
                world_.for_each_participant(i, role,
                                            [&](Ref r)
                                            {
                                                if (r.facet == Facet::Component && r.valid()) owner_of_part_.emplace_back(r.index, i);
                                            });
    }
    std::sort(owner_of_part_.begin(), owner_of_part_.end());
}

/// Collects what the component acts on: itself, its own participants, or, for a part such as a solver or a manager, those of all components
/// that have it.
void LevelBook::add_objects(std::uint32_t component, std::vector<Ref>& out, int depth) const
{
    constexpr int kDeepest = 4;  // a manager of a response of a detection
    const world::Component& c = world_.component(component);
    if (c.table == kNoIndex || depth > kDeepest) return;
    if (c.facet == Facet::Body || c.facet == Facet::Shaft)
    {
        out.push_back(c.ref(component));
        return;
    }
    bool any = false;
    for (const Role& role : world_.table_of(component).schema().roles())
    {
        if (!names_objects(role)) continue;
        any = true;
        world_.for_each_participant(component, role, [&](Ref r) { out.push_back(r); });
    }
    if (any) return;
    const auto first = std::lower_bound(owner_of_part_.begin(), owner_of_part_.end(), std::pair(component, 0u));
    for (auto owner = first; owner != owner_of_part_.end() && owner->first == component; ++owner)
        add_objects(owner->second, out, depth + 1);
}

Result<void> LevelBook::read_governor(Governor& governor) const
{
    governor.counts_energy = text_of(world_, governor.component, "unit") == "W";
    std::string written = text_of(world_, governor.component, "levels");
    if (governor.written == written && !governor.ladder.levels.empty()) return {};
    auto ladder = read_ladder(written, world_.types());
    if (!ladder) return ladder.errors();
    governor.ladder = ladder.take(), governor.written = std::move(written);
    return {};
}

/// A governor watches the components whose ids match and that can be exchanged for its levels.
Result<void> LevelBook::watch(Governor& governor, std::vector<std::uint32_t>& watcher) const
{
    governor.watches = text_of(world_, governor.component, "watches");
    governor.watched.clear();
    for (const std::uint32_t i : world_.in_id_order())
    {
        const world::Component& c = world_.component(i);
        if (c.table == kNoIndex || world_.table_of(i).type().info.family != governor.ladder.family) continue;
        if (!matches_any(governor.watches, c.id)) continue;
        if (watcher[i] != kNoIndex)
            return reason("watches " + model::quoted(c.id) + ", which " + model::quoted(world_.id_of(watcher[i])) + " watches already");
        watcher[i] = governor.component;
        Watched& watched = governor.watched.emplace_back();
        watched.component = i;
        add_objects(i, watched.objects, 0);
        std::erase_if(watched.objects, [&](Ref r) { return !moves(world_.host(), r); });
        std::sort(watched.objects.begin(), watched.objects.end());
        watched.objects.erase(std::unique(watched.objects.begin(), watched.objects.end()), watched.objects.end());
    }
    return {};
}

Result<void> LevelBook::rebuild()
{
    if (deciding_) return {};
    ++structure_;
    const world::Revisions now = world_.revisions();
    const bool only_solvers = built_from_ && now.only_solvers_since(*built_from_);
    built_from_.reset();
    if (!only_solvers)
        if (auto found = find_watched(); !found) return found;
    built_from_ = now;
    return {};
}

/// An exchange of solvers leaves all of this as it is: who watches whom, and on which objects they act.
Result<void> LevelBook::find_watched()
{
    std::vector<Governor> before;
    before.swap(governors_);
    std::vector<std::uint32_t> watcher(world_.components().size(), kNoIndex);
    changes_.resize(world_.components().size()), told_.resize(world_.components().size()), trials_.resize(world_.components().size());
    known_.resize(world_.components().size());
    for (const std::uint32_t i : stepper_.components())
    {
        const world::Component& c = world_.component(i);
        if (c.table == kNoIndex || c.quarantined) continue;
        const model::ComponentType& type = world_.table_of(i).type();
        if (!type.takes_part(Phase::Decide) || !type.schema.find_field("watches") || !type.schema.find_field("levels")) continue;
        const auto known = std::find_if(before.begin(), before.end(), [&](const Governor& g) { return g.component == i; });
        governors_.push_back(known == before.end() ? Governor{} : std::move(*known));
        governors_.back().component = i;
    }
    find_parts();
    for (Governor& governor : governors_)
    {
        auto done = read_governor(governor);
        if (done) done = watch(governor, watcher);
        if (done) continue;
        return Error{
            {}, world_.id_of(governor.component) + " (" + world_.type_of(governor.component)->info.name + ")", done.error().reason};
    }
    watcher_.resize(watcher.size(), kNoIndex);
    for (const std::uint32_t i : world_.in_id_order())
        if (watcher_[i] != watcher[i]) changed_.push_back(i);
    watcher_ = std::move(watcher);
    ids_.resize(governors_.empty() ? 0 : watcher_.size());
    for (std::uint32_t i = 0; i < ids_.size(); ++i) ids_[i] = world_.id_of(i);
    const world::HostTables& host = world_.host();
    radius_of_shaft_.assign(governors_.empty() ? 0 : host.shafts.size(), 0.0);
    for (std::size_t s = 0; s < radius_of_shaft_.size(); ++s)
        for (const Ref shape : host.shafts.shapes[s])
        {
            const Geometry& g = host.shapes.geometry[shape.index];
            radius_of_shaft_[s] = std::max(radius_of_shaft_[s], length(g.pose.p) + world::bounding_radius(g));
        }
    return {};
}

GovernedComponent LevelBook::look(const Governor& governor, const Watched& watched) const
{
    GovernedComponent out;
    out.component = watched.component, out.level = level_of(world_, watched.component, governor.ladder);
    out.objects = static_cast<std::uint32_t>(watched.objects.size());
    const Bodies& bodies = world_.host().bodies;
    const Shafts& shafts = world_.host().shafts;
    const auto place = [&](Ref r) { return r.facet == Facet::Body ? bodies.position[r.index] : shafts.axle[r.index].p; };
    const auto radius = [&](Ref r) { return r.facet == Facet::Body ? stepper_.radius_of_body()[r.index] : radius_of_shaft_[r.index]; };
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3 least{kInfinity, kInfinity, kInfinity}, most = -least;
    for (const Ref r : watched.objects)
    {
        const Vec3 p = place(r);
        const double size = radius(r);
        for (int k = 0; k < 3; ++k) least[k] = std::min(least[k], p[k] - size), most[k] = std::max(most[k], p[k] + size);
        // A turn does not take it out of the ball around it.
        const double speed = r.facet == Facet::Body ? length(bodies.velocity[r.index]) : 0.0;
        out.speed = std::max(out.speed, speed);
    }
    if (watched.objects.empty()) return out;
    out.center = 0.5 * (least + most);
    for (const Ref r : watched.objects) out.radius = std::max(out.radius, length(place(r) - out.center) + radius(r));
    return out;
}

namespace
{

double median_of(std::vector<double>& values)
{
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

bool is_input(const Schema& schema, const char* name)
{
    const Field* field = schema.find_field(name);
    return field && field->is_input;
}

}  // namespace

bool LevelBook::is_told(std::uint32_t governor, const char* input) const { return is_input(world_.table_of(governor).schema(), input); }

/// A governor may have a field `enough`, in m or in rad as its field `unit` says, which it sets before it asks for an error; 0: no limit.
LevelError LevelBook::enough_for(const Governor& governor) const
{
    LevelError out;
    const double enough = real_of(world_, governor.component, "enough");
    if (enough > 0) (text_of(world_, governor.component, "unit") == "rad" ? out.angle : out.distance) = enough;
    return out;
}

void LevelBook::note_exchange(std::size_t n, const StepCost& cost)
{
    decided_.exchanged += n, decided_.exchanging += cost;
    bool told = false;
    for (Governor& g : governors_)
    {
        g.exchanged += n, g.exchange_cost += cost, g.waits = true;
        told = told || is_told(g.component, "exchange_cost");
    }
    if (told) decided_.told += cost;
}

void LevelBook::note_tried(Governor& g, const StepCost& cost)
{
    ++g.tried, ++decided_.trials;
    g.trial_time += cost, decided_.trying += cost;
    if (is_told(g.component, "trial_time")) decided_.told += cost;
}

bool LevelBook::note_step(const StepCost& cost)
{
    decided_.step = cost;
    return decided_.told.wall == 0;
}

/// Whether a governor is told at this boundary what steps cost.
bool LevelBook::is_due(const Governor& g, double time, double dt, const StepTimes& steps) const
{
    constexpr std::size_t kFew = 4;  // steps after an exchange: their median is not that of the first one, which is longer
    if (!is_told(g.component, "step_cost") || steps.count() == 0) return false;
    const double told = real_of(world_, g.component, "step_cost");
    if (g.waits) return steps.count() >= kFew || told == 0;
    // The machine has become busy, or the scene takes more: who spends time has to know before its next look.
    constexpr double kMuchMore = 1.15;
    const StepCost recent = steps.recent();
    if ((text_of(world_, g.component, "clock") == "wall" ? recent.wall : recent.processor) > kMuchMore * told) return true;
    const double every = std::max(dt, real_of(world_, g.component, "every"));
    return std::floor(time / every + 1e-9) != std::floor((time - dt) / every + 1e-9);
}

std::vector<Request> LevelBook::measurements(double time, double dt, StepTimes& steps)
{
    std::vector<Request> out;
    bool used = false;
    for (Governor& g : governors_)
    {
        const bool by_wall = text_of(world_, g.component, "clock") == "wall";
        const auto counted = [&](const StepCost& c) { return by_wall ? c.wall : c.processor; };
        Request request;
        request.trial.budget = TrialChoice::Budget::None;
        const auto set = [&](const char* name, Value value)
        {
            if (is_told(g.component, name)) request.operations.push_back(SetOperation{world_.id_of(g.component), name, std::move(value)});
        };
        if (is_due(g, time, dt, steps))
        {
            used = true, g.waits = false;
            set("step_cost", Value(counted(steps.usual()))), set("spread", Value(counted(steps.spread())));
            Reals trials;
            for (std::vector<double>& seconds : g.trial_seconds) trials.push_back(median_of(seconds)), seconds.clear();
            if (std::any_of(trials.begin(), trials.end(), [](double s) { return s > 0; })) set("trial_costs", Value(std::move(trials)));
        }
        if (g.exchanged > 0)
            set("exchange_cost", Value(Reals{static_cast<double>(g.exchanged), counted(g.exchange_cost), counted(decided_.step)}));
        if (g.tried > 0) set("trial_time", Value(Reals{static_cast<double>(g.tried), counted(g.trial_time), counted(decided_.step)}));
        g.exchanged = g.tried = 0, g.exchange_cost = g.trial_time = {};
        if (!request.operations.empty()) out.push_back(std::move(request));
    }
    if (used) steps.go_on();
    return out;
}

/// A component that acts on many objects takes part with what it costs for each of them.
void LevelBook::note_trial(Governor& governor, std::size_t index, std::int32_t level, double interval, const TrialFindings& found,
                           std::vector<LevelTrial>& known)
{
    constexpr std::size_t kMostSamples = 64;
    const auto objects = static_cast<double>(std::max<std::size_t>(1, governor.watched[index].objects.size()));
    governor.trial_seconds.resize(governor.ladder.levels.size());
    known.resize(governor.ladder.levels.size());
    const auto note = [&](std::size_t l, double seconds)
    {
        known[l].level = static_cast<std::int32_t>(l), known[l].text = governor.ladder.levels[l].text;
        if (seconds <= 0) return;
        known[l].seconds = seconds;
        if (governor.trial_seconds[l].size() < kMostSamples) governor.trial_seconds[l].push_back(seconds / objects);
    };
    governor.trials += found.seconds > 0 ? 1 : 0;
    const auto l = static_cast<std::size_t>(level);
    note(l, found.seconds), note(l + 1, found.finer_seconds);
    known[l].error = found.error, known[l].interval = interval;
    if (l + 2 == known.size()) known[l + 1].error = {0, 0, 0};
}

const LevelBook::Watched* LevelBook::find_watched(const Governor& g, std::uint32_t component) const
{
    const auto before = [&](const Watched& w, std::uint32_t c) { return world_.rank(w.component) < world_.rank(c); };
    const auto found = std::lower_bound(g.watched.begin(), g.watched.end(), component, before);
    return found != g.watched.end() && found->component == component ? &*found : nullptr;
}

std::span<const Ref> LevelBook::objects_of(std::uint32_t component) const
{
    for (const Governor& g : governors_)
        if (component < watcher_.size() && watcher_[component] == g.component)
            if (const Watched* watched = find_watched(g, component)) return watched->objects;
    return {};
}

LevelInfo LevelBook::info(const Governor& g, const Watched& w) const
{
    LevelInfo out;
    out.component = w.component, out.governor = g.component;
    out.level = level_of(world_, w.component, g.ladder), out.levels = static_cast<std::int32_t>(g.ladder.levels.size());
    out.text = text_of_level(g, w.component, out.level);
    const Change& change = changes_[w.component];
    if (change.id == world_.id_of(w.component)) out.reason = change.reason, out.since = change.since, out.last = change.what;
    out.every = real_of(world_, g.component, "every");
    const Told& told = told_[w.component];
    if (told.by == g.component) out.error = told.error, out.error_unit = told.unit, out.next_look = told.next_look;
    for (const LevelTrial& trial : trials_[w.component])
        if (!trial.text.empty() && trial.level < out.levels) out.trials.push_back(trial);
    return out;
}

std::vector<LevelInfo> LevelBook::levels() const
{
    std::vector<LevelInfo> out;
    for (const Governor& g : governors_)
        for (const Watched& w : g.watched) out.push_back(info(g, w));
    return out;
}

std::optional<LevelInfo> LevelBook::level(std::uint32_t component) const
{
    if (component >= watcher_.size() || watcher_[component] == kNoIndex) return {};
    for (const Governor& g : governors_)
    {
        if (g.component != watcher_[component]) continue;
        if (const Watched* watched = find_watched(g, component)) return info(g, *watched);
    }
    return {};
}

}  // namespace plab::simulation
