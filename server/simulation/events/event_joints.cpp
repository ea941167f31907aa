// Impacts of bodies that joints hold. A response knows contacts only, so it is told how impulses at them change their velocities, joints
// included: W = J P M^-1 J^T, where P projects velocities onto the joints in the metric of M. It answers the impact in the space of the
// contacts by the same laws as that of free bodies, which make no energy; then its impulses act on the bodies, and the joints distribute
// them. W is found column by column, by impulses for trial.
//
// Source: F. Pfeiffer, C. Glocker, "Multibody dynamics with unilateral contacts", 1996, ch. 8.
#include <algorithm>

#include "simulation/events/event_locator.h"

namespace plab::simulation
{
namespace
{

/// Where detectors are answered in turn: impulses have done their part when closing speeds are below kOver of the first one.
constexpr int kMostRounds = 50;
constexpr double kOver = 1e-12;
/// Cost of a projection in units of the work budget, for each body of the group.
constexpr double kProjection = 2;
/// Where more contacts meet at once, W would be large: the response then answers as if bodies were free, and joints distribute its
/// impulses, in turn. Neither adds energy.
constexpr std::size_t kMostColumns = 192;

/// Number of columns of W.
std::size_t columns_of(std::span<const FoundContact> contacts)
{
    std::size_t columns = 0;
    for (const FoundContact& f : contacts) columns += f.contact.friction > 0 ? 3 : 1;
    return columns;
}

}  // namespace

/// Lists the groups of the impact that have joints, and all bodies and shafts whose velocities change. False if no group has joints.
bool EventLocator::find_jointed()
{
    Jointed& j = jointed_;
    j.groups.clear(), j.bodies.clear(), j.shafts.clear();
    for (const FoundContact& f : impact_)
        for (const Ref r : {f.contact.a, f.contact.b})
        {
            const std::uint32_t g = step_.groups.of(r);
            if (g == kNoIndex || !step_.world.host().bodies.dynamic(r.index)) continue;
            j.bodies.push_back(r.index);
            if (step_.groups.all[g].rows.empty()) continue;
            j.groups.push_back(g);
        }
    if (j.groups.empty()) return false;
    const auto unique = [](std::vector<std::uint32_t>& list)
    {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    unique(j.groups);
    for (const std::uint32_t g : j.groups)
    {
        const Group& group = step_.groups.all[g];
        j.bodies.insert(j.bodies.end(), group.bodies.begin(), group.bodies.end());
        j.shafts.insert(j.shafts.end(), group.shafts.begin(), group.shafts.end());
    }
    unique(j.bodies);
    return true;
}

void EventLocator::keep(Jointed::Speeds& speeds) const
{
    const world::HostTables& host = step_.world.host();
    speeds.velocity.clear(), speeds.spin.clear(), speeds.momentum.clear(), speeds.shaft.clear();
    for (const std::uint32_t b : jointed_.bodies)
    {
        speeds.velocity.push_back(host.bodies.velocity[b]), speeds.spin.push_back(host.bodies.angular_velocity[b]);
        speeds.momentum.push_back(host.bodies.angular_momentum[b]);
    }
    for (const std::uint32_t s : jointed_.shafts) speeds.shaft.push_back(host.shafts.speed[s]);
}

void EventLocator::put(const Jointed::Speeds& speeds)
{
    world::HostTables& host = step_.world.host();
    for (std::size_t i = 0; i < jointed_.bodies.size(); ++i)
    {
        const std::uint32_t b = jointed_.bodies[i];
        host.bodies.velocity[b] = speeds.velocity[i], host.bodies.angular_velocity[b] = speeds.spin[i];
        host.bodies.angular_momentum[b] = speeds.momentum[i];
    }
    for (std::size_t i = 0; i < jointed_.shafts.size(); ++i) host.shafts.speed[jointed_.shafts[i]] = speeds.shaft[i];
}

/// Projects the velocities of the jointed groups onto their joints, at `time` (s since the start of the step).
void EventLocator::join(double time, WorkBook book)
{
    for (const std::uint32_t g : jointed_.groups) join_group(g, time, book);
}

void EventLocator::join_group(std::uint32_t group, double time, WorkBook book)
{
    motion_.system_for(std::span(&group, 1), {}).begin(time, step_.frame.step, book, nullptr);
    budget_.spend(kProjection * static_cast<double>(step_.groups.all[group].bodies.size()));
}

double EventLocator::closing() const
{
    double most = 0;
    for (const FoundContact& f : impact_) most = std::max(most, -contacts_.normal_velocity(f.contact));
    return most;
}

/// m/s: of b's point relative to a's, W.
Vec3 EventLocator::relative_velocity(const Contact& c) const
{
    const Bodies& bodies = step_.world.host().bodies;
    return bodies.velocity_at(c.b.index, c.point) - bodies.velocity_at(c.a.index, c.point);
}

void EventLocator::apply_impulse(const Contact& c, const Vec3& impulse)
{
    Bodies& bodies = step_.world.host().bodies;
    if (bodies.dynamic(c.a.index)) bodies.apply_impulse(c.a.index, -impulse, c.point);
    if (bodies.dynamic(c.b.index)) bodies.apply_impulse(c.b.index, impulse, c.point);
}

/// Fills one column of W for the contacts in `part_`: what an impulse along `axis` at contact j does. Velocities are put back.
void EventLocator::find_column(std::size_t j, const Vec3& axis, double time)
{
    const Bodies& bodies = step_.world.host().bodies;
    const std::size_t n = part_.size();
    const Contact& c = part_[j].contact;
    // An impulse that changes velocities by about as much as they are: then rounding is least.
    const double mass = 1 / (bodies.inverse_mass[c.a.index] + bodies.inverse_mass[c.b.index]);
    const double size = mass * std::max(1e-3, jointed_.speed);
    apply_impulse(c, axis * size);
    for (const Ref r : {c.a, c.b})
        if (const std::uint32_t g = step_.groups.of(r); std::binary_search(jointed_.groups.begin(), jointed_.groups.end(), g))
            join_group(g, time, {});
    for (std::size_t i = 0; i < n; ++i)
    {
        const Vec3 u = (relative_velocity(part_[i].contact) - jointed_.before[i]) * (1 / size);
        jointed_.mobility[i * n + j] = jointed_.mobility[i * n + j] + outer(u, axis);
    }
    put(jointed_.start);
}

/// W of the contacts in `part_`, or nothing if it would be large.
std::span<const Mat3> EventLocator::find_mobility(double time)
{
    Jointed& j = jointed_;
    const std::size_t n = part_.size();
    if (columns_of(part_) > kMostColumns) return {};
    keep(j.start);
    j.before.clear(), j.speed = 0;
    for (const FoundContact& f : part_)
    {
        j.before.push_back(relative_velocity(f.contact));
        j.speed = std::max(j.speed, length(j.before.back()));
    }
    j.mobility.assign(n * n, Mat3{});
    for (std::size_t k = 0; k < n; ++k)
    {
        const Contact& c = part_[k].contact;
        find_column(k, c.normal, time);
        if (!(c.friction > 0)) continue;
        const Vec3 across = any_perpendicular(c.normal);
        find_column(k, across, time), find_column(k, cross(c.normal, across), time);
    }
    return j.mobility;
}

/// Answers the contacts of one detector once: `impact_` gets their impulses. Returns whether there were any.
bool EventLocator::respond_once(std::uint32_t detector, double time)
{
    part_.clear();
    for (const FoundContact& f : impact_)
        if (f.detector == detector) part_.push_back(f), part_.back().contact.impulse = {};
    if (part_.empty()) return false;
    const std::span<const Mat3> mobility = find_mobility(time);
    contacts_.respond(part_, ImpactMode::Impact, 0, step_.book(), mobility);
    if (!mobility.empty()) put(jointed_.start);  // a response that does not know of the mobility has changed them
    double work = 0;
    bool any = false;
    for (const FoundContact& f : part_)
    {
        const Vec3& impulse = f.contact.impulse;
        any = any || impulse != Vec3{};
        if (mobility.empty() || impulse == Vec3{}) continue;
        const Vec3 before = relative_velocity(f.contact);
        apply_impulse(f.contact, impulse);
        work += 0.5 * dot(impulse, before + relative_velocity(f.contact));
    }
    if (work != 0) step_.work[contacts_.detectors()[detector].response] += work;
    join(time, step_.book());
    std::size_t next = 0;
    for (FoundContact& f : impact_)
    {
        if (f.detector != detector) continue;
        const Vec3 sum = f.contact.impulse + part_[next].contact.impulse;
        f.contact = part_[next++].contact, f.contact.impulse = sum;
    }
    return any;
}

void EventLocator::respond(double time)
{
    if (!find_jointed())
    {
        contacts_.respond(impact_, ImpactMode::Impact, 0, step_.book());
        return;
    }
    for (FoundContact& f : impact_) f.contact.impulse = {};
    join(time, step_.book());
    const auto is_other = [&](const FoundContact& f) { return f.detector != impact_.front().detector; };
    // One detector is answered at once, as far as its response gets.
    const int rounds = std::ranges::any_of(impact_, is_other) || columns_of(impact_) > kMostColumns ? kMostRounds : 1;
    const double over = kOver * closing();
    bool any = true;
    for (int round = 0; any && (round == 0 || (round < rounds && closing() > over)); ++round)
    {
        any = false;
        for (std::uint32_t d = 0; d < contacts_.detectors().size(); ++d)
            if (contacts_.detectors()[d].responds) any = respond_once(d, time) || any;
    }
}

}  // namespace plab::simulation
