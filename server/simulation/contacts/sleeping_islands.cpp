// Which bodies are at rest, and which islands fall asleep.
#include "simulation/contacts/sleeping_islands.h"

#include <algorithm>
#include <cmath>

namespace plab::simulation
{
namespace
{

/// Takes the pairs of sleeping bodies out of the list.
std::vector<PairState> take_sleeping_pairs(ContactCache& cache)
{
    std::vector<PairState> taken;
    cache.drop_if(
        [&](PairState& p)
        {
            if (!cache.rest().asleep(p.a.index) && !cache.rest().asleep(p.b.index)) return false;
            taken.push_back(std::move(p));
            return true;
        });
    return taken;
}

}  // namespace

// Whether islands may sleep ----------------------------------------------------------------------------------------------

void SleepingIslands::rebuild()
{
    listed_ = nullptr;
    note_change();
    rules_.clear();
    for (const Detector& d : contacts_.detectors())
        rules_.push_back({{step_.world, d.manager, "sleep_after"},
                          {step_.world, d.manager, "sleep_speed"},
                          {step_.world, d.manager, "asleep"},
                          {step_.world, d.manager, "sleep_reason"}});
    find_groups_that_may_sleep();
}

/// With several managers the longest time and the lowest speed hold for all.
void SleepingIslands::read_rules()
{
    after_ = 0, speed_ = HUGE_VAL;
    on_ = !rules_.empty() && !motion_.extra();
    for (std::size_t d = 0; d < rules_.size(); ++d)
    {
        const Rule& rule = rules_[d];
        const double after = rule.after.value_or(0);
        on_ = on_ && contacts_.detectors()[d].by_rows && contacts_.detectors()[d].may_persist() && after > 0;
        after_ = std::max(after_, after);
        speed_ = std::min(speed_, rule.speed.value_or(0));
    }
}

std::uint32_t SleepingIslands::half_window() const
{
    const double steps = std::ceil(after_ / (2 * step_.frame.step));
    return static_cast<std::uint32_t>(std::clamp(steps, 1.0, 1e9));
}

/// Groups of bodies on which nothing acts but contacts, and forces that are the same at every time and in every state. Whatever follows
/// another clock or reads the state of something else may have to move at any time.
void SleepingIslands::find_groups_that_may_sleep()
{
    const auto& forces = step_.schedule.of(Phase::Force);
    const auto is_uniform = [&](const BlockRow& force) { return step_.world.tables()[forces[force.block].table]->type().info.uniform; };
    may_sleep_.assign(step_.groups.all.size(), 0);
    for (std::size_t g = 0; g < may_sleep_.size(); ++g)
    {
        const Group& group = step_.groups.all[g];
        const bool bodies_only = !group.bodies.empty() && group.shafts.empty() && group.quantities.empty();
        const bool free = group.rows.empty() && group.couplings.empty() && group.upstream.empty();
        may_sleep_[g] = bodies_only && free && std::all_of(group.forces.begin(), group.forces.end(), is_uniform) ? 1 : 0;
    }
    for (const Group& group : step_.groups.all)
        for (const std::uint32_t up : group.upstream) may_sleep_[up] = 0;
}

std::uint32_t SleepingIslands::manager_of(std::uint32_t detector) const
{
    for (const Detector& d : contacts_.detectors())
        if (d.component == detector) return d.manager;
    return kNoIndex;
}

// Bodies at rest ---------------------------------------------------------------------------------------------------------

bool SleepingIslands::is_quiet(std::uint32_t b, const RestSample& sample) const
{
    const Bodies& bodies = step_.world.host().bodies;
    const Vec3 v = bodies.velocity[b], w = bodies.angular_velocity[b];
    const double radius = contacts_.radius_of_body()[b];
    if (!(length(v) + length(w) * radius <= speed_)) return false;
    return length(v - sample.velocity) + length(w - sample.spin) * radius <= kNetShare * sample.acceleration * step_.frame.step;
}

/// Whether the mean speeds of the two halves of the window agree. Under a constant acceleration a they differ by a T/2.
bool SleepingIslands::is_steady(std::uint32_t b, const RestSample& sample) const
{
    const BodyRest& r = rest().bodies[b];
    const double half = half_window();
    const double most = std::min(kSteadyShare * speed_, kBalanceShare * sample.acceleration * half * step_.frame.step) * half;
    return length(r.moved - r.moved_before) + length(r.turned - r.turned_before) * contacts_.radius_of_body()[b] <= most;
}

void SleepingIslands::count_quiet_steps(std::span<const RestSample> samples)
{
    const Bodies& bodies = step_.world.host().bodies;
    const std::uint32_t window = 2 * half_window();
    for (const std::uint32_t b : awake_bodies_.members())
    {
        const std::uint32_t g = step_.groups.group_of_body[b];
        BodyRest& r = rest().bodies[b];
        if (g == kNoIndex || may_sleep_[g] == 0 || b >= samples.size() || samples[b].step != step_.serial || !is_quiet(b, samples[b]))
        {
            if (r.quiet > 0) r = {};
            continue;
        }
        r.quiet = std::min(r.quiet + 1, window);
        r.moved += bodies.velocity[b], r.turned += bodies.angular_velocity[b];
    }
}

void SleepingIslands::begin_half()
{
    for (const std::uint32_t b : awake_bodies_.members())
    {
        BodyRest& r = rest().bodies[b];
        if (r.quiet == 0) continue;
        r.moved_before = r.moved, r.turned_before = r.turned;
        r.moved = r.turned = {};
    }
}

// Falling asleep ---------------------------------------------------------------------------------------------------------

/// Sets states_ of all bodies that are awake. False if none of them is ready.
bool SleepingIslands::find_ready(std::span<const RestSample> samples)
{
    const std::uint32_t window = 2 * half_window();
    states_.assign(step_.world.host().bodies.size(), State::Moving);
    bool any = false;
    for (const std::uint32_t b : awake_bodies_.members())
    {
        if (rest().bodies[b].quiet < window || !is_steady(b, samples[b])) continue;
        states_[b] = State::Ready;
        any = true;
    }
    return any;
}

/// Joins bodies that touch. Whatever touches a body with prescribed motion is blocked, as that will not stay where it is.
void SleepingIslands::join_pairs()
{
    const Bodies& bodies = step_.world.host().bodies;
    sets_.reset(bodies.size());
    supported_.assign(bodies.size(), 0);
    for (const PairState& p : std::as_const(contacts_).cache().pairs())
    {
        const bool a = bodies.dynamic(p.a.index), b = bodies.dynamic(p.b.index);
        if (!p.resting)  // between two bounces
            for (const Ref r : {p.a, p.b})
                if (bodies.dynamic(r.index)) states_[r.index] = State::Blocked;
        if (a && b)
        {
            sets_.join(p.a.index, p.b.index);
            continue;
        }
        const std::uint32_t own = a ? p.a.index : p.b.index, other = a ? p.b.index : p.a.index;
        if (bodies.motion[other] != Motion::Static)
            states_[own] = State::Blocked;
        else if (!p.ahead)
            supported_[own] = 1;
    }
}

/// Puts the islands to sleep of which all bodies are ready. True if there are any.
bool SleepingIslands::fall_asleep()
{
    join_pairs();
    const Bodies& bodies = step_.world.host().bodies;
    for (const std::uint32_t b : awake_bodies_.members())
    {
        if (!bodies.dynamic(b)) continue;
        const std::uint32_t root = sets_.find(b);
        if (states_[b] != State::Ready) states_[root] = State::Blocked;
        supported_[root] = supported_[root] | supported_[b];
    }
    quiet_bodies_.clear();
    for (const std::uint32_t b : awake_bodies_.members())
        if (bodies.dynamic(b) && states_[sets_.find(b)] == State::Ready && supported_[sets_.find(b)] != 0) quiet_bodies_.push_back(b);
    if (quiet_bodies_.empty()) return false;
    const bool first = !any();
    for (const std::uint32_t b : quiet_bodies_) rest().bodies[b] = {}, rest().bodies[b].asleep = true;
    const std::size_t before = rest().islands.size();
    put_pairs_away();
    causes_.begin();
    for (std::size_t i = before; i < rest().islands.size(); ++i) put_to_sleep(*rest().islands[i]);
    if (first) rest().scene_cause = causes_.of_scene();
    return true;
}

/// Takes away the velocities of an island's bodies. The energy that goes with them is work of the manager.
void SleepingIslands::put_to_sleep(const SleepingIsland& island)
{
    Bodies& bodies = step_.world.host().bodies;
    double energy = 0;
    for (const std::uint32_t b : island.bodies)
    {
        energy += bodies.kinetic_energy(b);
        bodies.velocity[b] = bodies.angular_velocity[b] = bodies.angular_momentum[b] = {};
    }
    if (const std::uint32_t manager = manager_of(island.pairs.front().detector); manager != kNoIndex) step_.work[manager] -= energy;
    for (const PairState& p : island.pairs) causes_.add_pair(p);
    for (const std::uint32_t b : island.bodies) rest().bodies[b].cause = causes_.of_body(b);
    report("island.asleep", island, "", {}, energy);
}

/// Takes the pairs of sleeping bodies out of the cache's list, into islands.
void SleepingIslands::put_pairs_away()
{
    RestState& r = rest();
    const Bodies& bodies = step_.world.host().bodies;
    std::vector<PairState> taken = take_sleeping_pairs(contacts_.cache());
    sets_.reset(bodies.size());
    for (const PairState& p : taken)
        if (bodies.dynamic(p.a.index) && bodies.dynamic(p.b.index)) sets_.join(p.a.index, p.b.index);
    std::vector<std::uint32_t> sleepers;
    island_of_body_.assign(bodies.size(), kNoIndex);
    for (std::uint32_t i = 0; i < r.islands.size(); ++i)
        for (const std::uint32_t b : r.islands[i]->bodies) island_of_body_[b] = i;
    for (std::uint32_t b = 0; b < r.bodies.size(); ++b)
        if (r.bodies[b].asleep && island_of_body_[b] == kNoIndex) sleepers.push_back(b);
    const auto rank = [&](std::uint32_t b) { return step_.world.rank(Ref{Facet::Body, b}); };
    std::sort(sleepers.begin(), sleepers.end(), [&](std::uint32_t x, std::uint32_t y) { return rank(x) < rank(y); });
    std::vector<std::shared_ptr<SleepingIsland>> fresh;
    std::vector<std::uint32_t> number(bodies.size(), kNoIndex);  // by representative
    for (const std::uint32_t b : sleepers)
    {
        std::uint32_t& own = number[sets_.find(b)];
        if (own == kNoIndex) own = static_cast<std::uint32_t>(fresh.size()), fresh.push_back(std::make_shared<SleepingIsland>());
        fresh[own]->bodies.push_back(b);
    }
    for (PairState& p : taken)
    {
        // A request may have put a body that is awake in the place of one that slept: then the others have to wake.
        for (const auto& [own, other] : {std::pair(p.a, p.b), std::pair(p.b, p.a)})
            if (r.asleep(own.index) && bodies.dynamic(other.index) && !r.asleep(other.index)) r.bodies[own.index].cause = 0;
        SleepingIsland& own = *fresh[number[sets_.find(r.asleep(p.a.index) ? p.a.index : p.b.index)]];
        own.points += p.count;
        own.pairs.push_back(std::move(p));
    }
    r.islands.insert(r.islands.end(), fresh.begin(), fresh.end());
    r.note_change();
    contacts_.resting().forget();
}

// The step ---------------------------------------------------------------------------------------------------------------

bool SleepingIslands::finish_step(std::span<const RestSample> samples, std::span<const PairState> fresh)
{
    if (!on_) return false;
    now_ = step_.frame.start_time + step_.frame.step;
    const bool woke = wake_touched(fresh);
    count_quiet_steps(samples);
    if ((step_.frame.tick + 1) % half_window() != 0) return woke;
    const bool slept = find_ready(samples) && fall_asleep();
    if (slept) list_awake();
    begin_half();
    return woke || slept;
}

/// Lists what a step goes through while others sleep.
void SleepingIslands::list_awake()
{
    const Bodies& bodies = step_.world.host().bodies;
    RestState& r = rest();
    awake_bodies_.begin(bodies.size());
    for (const std::uint32_t i : step_.world.in_id_order())
        if (const world::Component& c = step_.world.component(i); c.facet == Facet::Body && c.host_index != kNoIndex)
            if (bodies.motion[c.host_index] != Motion::Static && !r.asleep(c.host_index)) awake_bodies_.add(c.host_index);
    awake_groups_.clear();
    for (std::uint32_t g = 0; g < step_.groups.all.size(); ++g)
        if (const Group& group = step_.groups.all[g]; group.bodies.empty() || !r.asleep(group.bodies.front())) awake_groups_.push_back(g);
    island_of_body_.assign(bodies.size(), kNoIndex);
    for (std::uint32_t i = 0; i < r.islands.size(); ++i)
        for (const std::uint32_t b : r.islands[i]->bodies) island_of_body_[b] = i;
    r.awake = awake_bodies_.members(), r.lists_awake = true;
    listed_ = r.mark;
    contacts_.detect_among(any() ? &awake_bodies_ : nullptr);
    publish();
}

/// Writes the outputs of managers.
void SleepingIslands::publish()
{
    const std::string why = reason();
    for (const Rule& rule : rules_)
    {
        if (std::int64_t* const count = rule.asleep.value()) *count = 0;
        if (std::string* const text = rule.reason.value()) *text = why;
    }
    for (const auto& island : rest().islands)
        for (std::size_t d = 0; d < rules_.size() && !island->pairs.empty(); ++d)
            if (std::int64_t* const count = rules_[d].asleep.value();
                count && contacts_.detectors()[d].component == island->pairs.front().detector)
                *count += static_cast<std::int64_t>(island->bodies.size());
}

/// Why islands, or some bodies, do not sleep; empty if all may, and if nobody asks for it.
std::string SleepingIslands::reason() const
{
    if (after_ == 0) return {};
    if (motion_.extra()) return "contacts that are forces keep everything awake";
    for (std::size_t d = 0; d < rules_.size(); ++d)
    {
        const Detector& detector = contacts_.detectors()[d];
        const std::string& id = step_.world.id_of(detector.component);
        if (!detector.by_rows) return id + " keeps everything awake: its response is not by rows";
        if (!detector.may_persist()) return id + " keeps everything awake: it locates impacts inside the step";
        if (!(rules_[d].after.value_or(0) > 0)) return id + " keeps everything awake: its manager has no sleep_after";
    }
    std::size_t never = 0;
    for (std::size_t g = 0; g < may_sleep_.size(); ++g)
        if (may_sleep_[g] == 0) never += step_.groups.all[g].bodies.size();
    if (never == 0) return {};
    return std::to_string(never) + " bodies stay awake: joints act on them, or forces that may change, or something reads their state";
}

void SleepingIslands::report(const char* kind, const SleepingIsland& island, const char* message, Ref by, double energy)
{
    Event e;
    e.time = now_, e.kind = kind, e.message = message;
    e.component = island.pairs.empty() ? kNoIndex : manager_of(island.pairs.front().detector);
    e.a = {Facet::Body, island.bodies.front()}, e.b = by;
    e.values = {static_cast<double>(island.bodies.size()), energy};
    step_.emit(std::move(e));
}

}  // namespace plab::simulation
