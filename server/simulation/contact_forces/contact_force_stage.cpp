// Force contacts at a stage of the solver: detection, matching with the known contacts, and evaluation of the laws.
#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

#include "plab/rotation.h"
#include "simulation/contact_forces/contact_forces.h"
#include "simulation/contact_forces/rim_near_level.h"
#include "simulation/motion/component_call.h"

namespace plab::simulation
{

/// Selects the pairs and bodies of some groups.
void ContactForces::bind(std::span<const std::uint32_t> groups)
{
    const auto inside = [&](Ref r)
    {
        const std::uint32_t g = step_.groups.of(r);
        return g != kNoIndex && dynamic(r) && std::binary_search(groups.begin(), groups.end(), g);
    };
    pairs_.clear();
    for (const NearPair& p : near_)
        if (inside(p.a) || inside(p.b)) pairs_.push_back(p);
    list_bodies();
    list_pushing();
}

/// Selects the pairs and bodies of an island, before its pieces.
void ContactForces::bind(const Island& island)
{
    pairs_.clear();
    for (const std::uint32_t i : island.near) pairs_.push_back(near_[i]);
    list_bodies();
    list_pushing();
}

void ContactForces::list_bodies()
{
    bodies_.begin(step_.world.host().bodies.size());
    for (const NearPair& p : pairs_) bodies_.add(p.a.index), bodies_.add(p.b.index);
    bodies_.sort();
}

bool ContactForces::precedes(const ForcePair& x, const ForcePair& y) const
{
    const world::World& world = step_.world;
    const auto key = [&](const ForcePair& p) { return std::tuple(world.rank(p.detector), world.rank(p.a), world.rank(p.b)); };
    return key(x) < key(y);
}

std::vector<ForcePair>::iterator ContactForces::place_of(std::vector<ForcePair>& pairs, std::uint32_t detector, Ref a, Ref b)
{
    const world::World& world = step_.world;
    const auto key = [&](std::uint32_t d, Ref x, Ref y) { return std::tuple(world.rank(d), world.rank(x), world.rank(y)); };
    return std::lower_bound(pairs.begin(), pairs.end(), key(detector, a, b),
                            [&](const ForcePair& p, const auto& k) { return key(p.detector, p.a, p.b) < k; });
}

/// Contacts are visited in the order in which the pairs are sorted, so the pair wanted is mostly the last one found, or the next.
ForcePair* ContactForces::find_pair(std::uint32_t detector, Ref a, Ref b)
{
    const auto is_it = [&](std::size_t i)
    {
        if (i >= live_.pairs.size()) return false;
        const ForcePair& p = live_.pairs[i];
        return p.detector == detector && p.a == a && p.b == b;
    };
    if (is_it(last_pair_)) return &live_.pairs[last_pair_];
    if (is_it(last_pair_ + 1)) return &live_.pairs[++last_pair_];
    const auto at = static_cast<std::size_t>(place_of(live_.pairs, detector, a, b) - live_.pairs.begin());
    if (!is_it(at)) return nullptr;
    last_pair_ = at;
    return &live_.pairs[at];
}

void ContactForces::list_pushing()
{
    pushing_.clear();
    for (const NearPair& n : pairs_)
    {
        const ForcePair* pair = find_pair(contacts_.detectors()[n.detector].component, n.a, n.b);
        if (!pair) continue;
        const auto i = static_cast<std::uint32_t>(pair - live_.pairs.data());
        for (std::uint32_t k = 0; k < pair->count; ++k)
            if (!pair->contacts[k].dormant) pushing_.push_back({i, k});
    }
}

ForceContact* ContactForces::find_known(const FoundContact& f)
{
    ForcePair* pair = find_pair(contacts_.detectors()[f.detector].component, f.contact.a, f.contact.b);
    return pair ? pair->find(f.contact.feature) : nullptr;
}

ForceContact* ContactForces::find_pushing(const FoundContact& f)
{
    ForceContact* known = find_known(f);
    return known && !known->dormant ? known : nullptr;
}

void ContactForces::anchor()
{
    const Bodies& bodies = step_.world.host().bodies;
    for (const std::uint32_t b : bodies_.members()) anchors_[b] = {bodies.position[b], bodies.orientation[b]};
}

void ContactForces::detect(std::uint32_t index, std::span<const PersistentPair> pairs, double margin, std::vector<FoundContact>& out)
{
    const Detector& detector = contacts_.detectors()[index];
    ContactCollector sink(step_.world, out);
    sink.begin_query(index, pairs, true, margin);
    sink.want_level_rims();
    ComponentCall query(step_, *step_.world.tables()[detector.table], detector.row);
    query.context.events = nullptr, query.arguments.contacts = &sink;
    // The detector has looked at all bodies in find_near(), and need not do so in each evaluation. When contacts are converted it has not.
    if (!bodies_.members().empty()) query.context.active_bodies = bodies_.flags();
    step_.report.visited += bodies_.members().empty() ? step_.world.host().bodies.size() : bodies_.members().size();
    const std::size_t first = out.size();
    (void)query.run(*detector.command);  // an error occurs again in the detection at the end of the step, which reports it
    for (FoundContact& found : std::span(out).subspan(first)) round_rim_near_level(found.contact);
}

void ContactForces::fill_surface(FoundContact& f) const
{
    const world::HostTables& host = step_.world.host();
    const std::uint32_t ma = host.bodies.material[f.contact.a.index], mb = host.bodies.material[f.contact.b.index];
    const SurfaceLaw* own = host.materials.find_pair(ma, mb);
    const SurfaceLaw& law = own ? *own : surfaces_[f.detector];
    f.contact.friction = law.friction, f.contact.restitution = law.restitution;
}

/// Detects all contacts of the island at the present state, also those that do not push yet: the search for switching events needs their
/// depths (contact_force_switch.cpp).
void ContactForces::inspect(double margin, std::vector<Seen>& out)
{
    found_.clear();
    for (std::size_t i = 0; i < pairs_.size();)
    {
        persistent_.clear();
        const std::uint32_t d = pairs_[i].detector;
        for (; i < pairs_.size() && pairs_[i].detector == d; ++i) persistent_.push_back({pairs_[i].a, pairs_[i].b, {}});
        detect(d, persistent_, margin, found_);
    }
    sort_contacts(found_, step_.world);
    out.clear();
    for (FoundContact& f : found_)
    {
        fill_surface(f);
        out.push_back({f, contacts_.normal_velocity(f.contact)});
    }
}

/// m: displacement of b's surface along a's since the piece began. The error is of third order in the rotation if the contact point is a
/// corner. For a ball the contact point stays below the centre, so the quadratic term is normal to the surface and drops out: a rolling
/// ball has no displacement at all.
Vec3 ContactForces::moved_along(const FoundContact& f) const
{
    const Bodies& bodies = step_.world.host().bodies;
    const auto displacement = [&](std::uint32_t b)
    {
        const Anchor& start = anchors_[b];
        const Vec3 turn = log_rotation(bodies.orientation[b] * conjugate(start.orientation));
        const Vec3 arm = f.contact.point - bodies.position[b];
        return (bodies.position[b] - start.position) + cross(turn, arm) - 0.5 * cross(turn, cross(turn, arm));
    };
    return displacement(f.contact.b.index) - displacement(f.contact.a.index);
}

/// Detects the contacts of pushing pairs at the present state.
void ContactForces::detect_pushing()
{
    found_.clear();
    for (std::size_t i = 0; i < pushing_.size();)
    {
        const std::uint32_t component = live_.pairs[pushing_[i].pair].detector;
        std::uint32_t d = 0;
        while (contacts_.detectors()[d].component != component) ++d;
        persistent_.clear();
        for (; i < pushing_.size() && live_.pairs[pushing_[i].pair].detector == component; ++i)
            if (i == 0 || pushing_[i].pair != pushing_[i - 1].pair)
                persistent_.push_back({live_.pairs[pushing_[i].pair].a, live_.pairs[pushing_[i].pair].b, {}});
        detect(d, persistent_, margin_, found_);
    }
    sort_contacts(found_, step_.world);
}

/// Finds the pushing contact points among those detected. With `extrapolate`, depth and stretch are those expected time_ahead_ later.
void ContactForces::match(bool extrapolate)
{
    matched_.clear();
    for (std::size_t begin = 0, end = 0; begin < found_.size(); begin = end)
    {
        const Contact& first = found_[begin].contact;
        for (end = begin + 1; end < found_.size() && same_pair(found_[end], found_[begin]);) ++end;
        ForcePair* pair = find_pair(contacts_.detectors()[found_[begin].detector].component, first.a, first.b);
        if (!pair) continue;
        const Renamed renamed =
            find_renamed(*pair, end - begin, [&](std::size_t k) -> const Contact& { return found_[begin + k].contact; });
        for (std::size_t i = begin; i < end; ++i)
        {
            ForceContact* const known = renamed.known && i == begin + renamed.place ? renamed.known : pair->find(found_[i].contact.feature);
            if (known && !known->dormant) add_match(i, *known, extrapolate);
        }
    }
}

/// Fills the stored state of a point into what was detected.
void ContactForces::add_match(std::size_t i, ForceContact& known, bool extrapolate)
{
    FoundContact& f = found_[i];
    Contact& c = f.contact;
    fill_surface(f);
    c.id = known.id, c.approach = known.approach, c.rest_depth = known.rest_depth, c.preload = known.preload;
    Vec3 stretch = known.stretch + moved_along(f);
    if (extrapolate)
    {
        const Bodies& bodies = step_.world.host().bodies;
        const Vec3 u = bodies.velocity_at(c.b.index, c.point) - bodies.velocity_at(c.a.index, c.point);
        c.depth -= time_ahead_ * dot(u, c.normal);
        stretch += u * time_ahead_;
    }
    c.stretch = stretch - c.normal * dot(stretch, c.normal);
    matched_.push_back({i, &known});
}

/// Evaluates the force laws of the gathered contacts, one call for each detector's response.
void ContactForces::run_laws(const StepContext& context, Wrenches& wrenches)
{
    StepContext own = context;
    for (std::size_t i = 0; i < matched_.size();)
    {
        const std::size_t first = i;
        const std::uint32_t d = found_[matched_[i].first].detector;
        law_contacts_.clear();
        for (; i < matched_.size() && found_[matched_[i].first].detector == d; ++i)
            law_contacts_.push_back(found_[matched_[i].first].contact);
        run_force_laws(step_.world, contacts_.detectors()[d].response, own, law_contacts_, step_.world.host().bodies, wrenches);
        for (std::size_t k = first; k < i; ++k) found_[matched_[k].first].contact = law_contacts_[k - first];
    }
}

void ContactForces::add(const StepContext& context, Wrenches& wrenches)
{
    if (time_ahead_ == 0)
    {
        detect_pushing();
        match(false);
        run_laws(context, wrenches);
        return;
    }
    // Time stepping of a mixed island evaluates forces once, and calls again to book their work at other velocities: the forces must not
    // change in between.
    if (!std::exchange(taken_, true))
    {
        detect_pushing();
        match(true);
        run_laws(context, scratch_);
        clear_scratch();
    }
    for (const auto& [i, known] : matched_)
    {
        const Contact& c = found_[i].contact;
        if (!is_advanced(context, c)) continue;
        wrenches.begin(contacts_.detectors()[found_[i].detector].response);
        if (dynamic(c.a)) wrenches.add_force_at(c.a, -c.impulse, c.point);
        if (dynamic(c.b)) wrenches.add_force_at(c.b, c.impulse, c.point);
    }
}

bool ContactForces::is_advanced(const StepContext& context, const Contact& c) const
{
    return (dynamic(c.a) && context.active(c.a)) || (dynamic(c.b) && context.active(c.b));
}

void ContactForces::clear_scratch()
{
    for (const auto& match : matched_)
        for (const Ref r : {found_[match.first].contact.a, found_[match.first].contact.b})
            scratch_.force[r.index] = scratch_.torque[r.index] = {};
}

/// Books the work of the contacts of one stage, weighted by its share of the step, to their responses.
void ContactForces::book(const StepContext& context, std::vector<double>& work, std::vector<double>& power, double share)
{
    for (std::size_t k = 0; k < matched_.size(); ++k)
    {
        const FoundContact& f = found_[matched_[k].first];
        if (!is_advanced(context, f.contact)) continue;
        const std::uint32_t response = contacts_.detectors()[f.detector].response;
        work[response] += share * power[response];
        power[response] = 0;
        matched_[k].second->impulse += f.contact.impulse * share;
    }
}

/// Evaluates the laws at the present state, outside of solver stages; after inspect(), which has detected all contacts.
void ContactForces::evaluate_laws()
{
    match(false);
    StepContext context;
    context.time = step_.frame.start_time, context.dt = step_.frame.step, context.tick = step_.frame.tick;
    run_laws(context, scratch_);
    clear_scratch();
}

/// Whether a damper has become slack or taut since the piece began: a switch, like the begin and the end of a contact.
bool ContactForces::any_slack_change() const
{
    const auto changed = [&](const auto& match)
    {
        const Contact& c = found_[match.first].contact;
        return match.second->slack != (c.impulse == Vec3{} && c.depth > match.second->open_depth + rounding(c));
    };
    return std::any_of(matched_.begin(), matched_.end(), changed);
}

/// Commits the state of the contacts after a finished piece. evaluate_laws() has been called at its end; the history of the contacts
/// changes nowhere else.
void ContactForces::commit(double t, double h)
{
    const double time = step_.frame.start_time + t;
    for (const auto& [i, known] : matched_)
    {
        const Contact& c = found_[i].contact;
        // In an oscillation at the frequency w, the rate of change of force times mobility is w^2 times the speed, which gives the speed
        // amplitude. The estimate decays within memory_ half periods.
        const double rate = std::numbers::pi / known->half_period;
        const double speed = h > 0 ? length(c.impulse - known->force) * known->rates.mobility / (h * rate * rate) : 0.0;
        known->swing_speed = std::max(speed, known->swing_speed * (1 - std::min(0.5, h / (memory_ * known->half_period))));
        // The reference is the largest of the speed so far and the speed of an oscillation whose amplitude is the static deflection.
        known->peak_swing_speed = std::max({known->peak_swing_speed, known->swing_speed, length(c.impulse) * known->rates.mobility / rate});
        known->stretch = c.stretch, known->force = c.impulse, known->depth = c.depth;
        if (c.depth > 1.05 * known->peak) expect(*known, found_[i], 0);
        known->slack = c.impulse == Vec3{} && c.depth > known->open_depth + rounding(c);
        ForcePair* pair = find_pair(contacts_.detectors()[found_[i].detector].component, c.a, c.b);
        pair->normal = c.normal;
        if (time - known->begin > 2 * known->half_period) report_impact_once(*pair, *known, c, time);
    }
    anchor();
}

}  // namespace plab::simulation
