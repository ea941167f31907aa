// Which pairs may touch by force within a step, and which groups advance together because of it.
#include "simulation/contact_forces/contact_forces.h"

#include <algorithm>
#include <tuple>

namespace plab::simulation
{

namespace
{

constexpr int kMostMarginRounds = 64;
constexpr double kSameMotionMargin = 1 + 1e-9,
                 kLeastMotionMargin = 0.01;  // the latter as a fraction of a body's radius, so that resting bodies take no second pass

}  // namespace

void ContactForces::rebuild()
{
    const world::World& world = step_.world;
    by_force_.clear();
    for (const Detector& d : contacts_.detectors()) by_force_.push_back(d.by_force ? 1 : 0);
    any_ = std::find(by_force_.begin(), by_force_.end(), 1) != by_force_.end();
    near_.clear(), pairs_.clear(), bodies_.clear();
    live_ = {}, segment_ = {}, end_ = {};
    convert_contacts();
    if (!any_) return;
    const world::HostTables& host = world.host();
    memento_.save(host), observed_memento_.save(host);
    anchors_.resize(host.bodies.size());
    scratch_.bind(host.bodies, host.shafts);
    scratch_.force.assign(host.bodies.size(), {}), scratch_.torque.assign(host.bodies.size(), {});
    for (auto& sums : sums_) sums.assign(host.bodies.size(), 0.0);
    make_room();
}

/// Reserves memory, so that steps with few near bodies do not allocate when their number changes.
void ContactForces::make_room()
{
    constexpr std::size_t kRoom = 32;
    near_.reserve(kRoom), near_found_.reserve(kRoom);
    islands_.resize(std::max(islands_.size(), std::min(kRoom, step_.groups.all.size())));
    for (Island& island : islands_) island.groups.reserve(kRoom), island.observed.reserve(kRoom);
}

bool ContactForces::dynamic(Ref r) const { return step_.world.host().bodies.dynamic(r.index); }

double ContactForces::speed_of(Ref r) const
{
    const Bodies& bodies = step_.world.host().bodies;
    const double spin = length(bodies.angular_velocity[r.index]), radius = contacts_.radius_of_body()[r.index];
    return length(bodies.velocity[r.index]) + (spin > 0 ? spin * radius : 0.0);
}

double ContactForces::positions_of(Ref a, Ref b) const
{
    const Bodies& bodies = step_.world.host().bodies;
    return length(bodies.position[a.index]) + length(bodies.position[b.index]);
}

bool ContactForces::involves(Ref a, Ref b, std::uint32_t group) const { return step_.groups.of(a) == group || step_.groups.of(b) == group; }

/// Copies what belongs to the pairs of a group, when the group is rewound or saved. A pair of two groups is copied with either of them;
/// both are always rewound together, because near pairs join their groups to one scope (close_over).
void ContactForces::transfer(const ForceState& from, ForceState& to, std::uint32_t group)
{
    const auto here = [&](const auto& x) { return involves(x.a, x.b, group); };
    if (from.pairs.empty() && to.pairs.empty() && from.events.empty() && to.events.empty()) return;
    std::erase_if(to.pairs, here), std::erase_if(to.events, here);
    std::copy_if(from.pairs.begin(), from.pairs.end(), std::back_inserter(to.pairs), here);
    std::copy_if(from.events.begin(), from.events.end(), std::back_inserter(to.events), here);
    const world::World& world = step_.world;
    const auto key = [&](const ForcePair& p) { return std::tuple(world.rank(p.detector), world.rank(p.a), world.rank(p.b)); };
    std::sort(to.pairs.begin(), to.pairs.end(), [&](const ForcePair& x, const ForcePair& y) { return key(x) < key(y); });
}

/// Prepares a step: copies the known contacts, evaluates once how far each body may move, and lists the pairs that may meet. Only these
/// are detected at the stages of the solver.
void ContactForces::begin_step()
{
    live_.pairs = contacts_.cache().force_pairs();
    live_.events.clear();
    near_.clear();
    pieces_needed_ = 0, stiff_ = kNoIndex;
    surfaces_.clear();
    for (std::uint32_t d = 0; d < by_force_.size(); ++d) surfaces_.push_back(by_force_[d] ? contacts_.response_law(d) : SurfaceLaw{});
    motion_margin_.assign(step_.world.host().bodies.size(), 0.0);
    fill_motion_margins(step_.frame.step);
    find_near();
    spread_motion_margins();
    segment_ = live_;
}

void ContactForces::fill_motion_margins(double h)
{
    // Displacement by the present velocities and forces, with half of it added for changes during the step.
    GroupSystem& system = motion_.system_for(step_.all_groups, {});
    // begin() projects velocities onto joint rows that are new. That does work, which has to be booked by the first call, this one.
    system.begin(0, h, step_.book(), nullptr);
    system.evaluate(0, 0);
    const auto members = system.bodies();
    for (std::size_t i = 0; i < members.size(); ++i) motion_margin_[members[i]] = 0.75 * h * h * length(system.acceleration(i));
    const Bodies& bodies = step_.world.host().bodies;
    for (std::uint32_t b = 0; b < motion_margin_.size(); ++b)
    {
        if (bodies.motion[b] == Motion::Static) continue;
        const double travel = speed_of({Facet::Body, b}) * h;
        motion_margin_[b] += bodies.dynamic(b) ? 1.5 * travel : travel;
    }
}

/// A body that is hit within the step may leave with the speed of the impact and hit the next one: propagates motion margins along chains
/// of near pairs.
void ContactForces::spread_motion_margins()
{
    for (int round = 0; raise_motion_margins(); ++round)
    {
        const bool is_last = round == kMostMarginRounds;
        if (is_last) level_motion_margins();
        find_near();
        if (is_last) return;
    }
}

/// Raises the motion margins of near pairs until they are consistent; false if they already were. In a head-on elastic impact of m on m' at
/// rest, m' leaves with 2 m / (m + m') of the speed of m. Around a closed chain of pairs the product of these factors is at most 1, so the
/// iteration ends.
bool ContactForces::raise_motion_margins()
{
    const Bodies& bodies = step_.world.host().bodies;
    const auto hits = [&](Ref a, Ref b)
    {
        if (!dynamic(b)) return false;
        const double share = dynamic(a) ? 2 / (1 + bodies.mass[b.index] * bodies.inverse_mass[a.index]) : 2.0;
        const double motion_margin = share * motion_margin_[a.index];
        if (!(motion_margin > motion_margin_[b.index] * kSameMotionMargin &&
              motion_margin > kLeastMotionMargin * contacts_.radius_of_body()[b.index]))
            return false;
        motion_margin_[b.index] = motion_margin;
        return true;
    };
    bool raised = false;
    for (bool again = true; again; raised = raised || again)
    {
        again = false;
        for (const NearPair& p : near_)
        {
            if (hits(p.a, p.b)) again = true;
            if (hits(p.b, p.a)) again = true;
        }
    }
    return raised;
}

/// For chains of bodies longer than the number of rounds: gives every dynamic body at least the largest margin.
void ContactForces::level_motion_margins()
{
    const double most = *std::max_element(motion_margin_.begin(), motion_margin_.end());
    for (std::uint32_t b = 0; b < motion_margin_.size(); ++b)
        if (dynamic({Facet::Body, b})) motion_margin_[b] = std::max(motion_margin_[b], most);
}

void ContactForces::add_near(std::uint32_t detector, Ref a, Ref b)
{
    if (dynamic(a) || dynamic(b)) near_.push_back({detector, a, b});
}

void ContactForces::find_near()
{
    const world::World& world = step_.world;
    for (std::uint32_t d = 0; d < by_force_.size(); ++d)
    {
        if (!by_force_[d]) continue;
        const Detector& detector = contacts_.detectors()[d];
        near_found_.clear();
        NearCollector sink(world, motion_margin_, near_found_);
        contacts_.query(detector, sink);
        for (const NearCollector::Pair& p : near_found_) add_near(d, p.a, p.b);
        for (const ForcePair& p : live_.pairs)
            if (p.detector == detector.component) add_near(d, p.a, p.b);
    }
    const auto key = [&](const NearPair& p) { return std::tuple(p.detector, world.rank(p.a), world.rank(p.b)); };
    std::sort(near_.begin(), near_.end(), [&](const NearPair& x, const NearPair& y) { return key(x) < key(y); });
    near_.erase(std::unique(near_.begin(), near_.end(), [&](const NearPair& x, const NearPair& y) { return key(x) == key(y); }),
                near_.end());
}

bool ContactForces::within_motion_margins(std::span<const std::uint32_t> groups, double h) const
{
    for (const std::uint32_t g : groups)
        for (const std::uint32_t b : step_.groups.all[g].bodies)
            if (speed_of({Facet::Body, b}) * h > motion_margin_[b]) return false;
    return true;
}

void ContactForces::join(DisjointSets& sets) const
{
    for (const NearPair& p : near_)
        if (dynamic(p.a) && dynamic(p.b)) sets.join(step_.groups.of(p.a), step_.groups.of(p.b));
}

void ContactForces::flag_near(std::vector<std::uint8_t>& groups) const
{
    for (const NearPair& p : near_)
        if (dynamic(p.a) && dynamic(p.b)) groups[step_.groups.of(p.a)] = groups[step_.groups.of(p.b)] = 1;
}

bool ContactForces::close_over(std::vector<std::uint8_t>& in_scope) const
{
    bool grown = false;
    for (const NearPair& p : near_)
    {
        if (!dynamic(p.a) || !dynamic(p.b)) continue;
        std::uint8_t &a = in_scope[step_.groups.of(p.a)], &b = in_scope[step_.groups.of(p.b)];
        grown = grown || a != b;
        a = b = a | b;
    }
    return grown;
}

}  // namespace plab::simulation
