// Impacts of bodies that joints hold. A response knows contacts only, so after its impulses the velocities of the group are projected
// onto the joint constraints again, and both are repeated in turn until neither changes anything (block Gauss-Seidel). That gives the
// end of the compression phase. The restitution phase then applies e times the normal impulses of the compression, and at sliding
// contacts e times the whole impulse (Poisson's hypothesis), and the joints distribute them by another projection. Without friction
// this is Newton's law, u' = -e u, and e = 1 conserves the energy: the projection is orthogonal in the metric of M. With friction the
// result is checked (answer_without_gain).
//
// Source: F. Pfeiffer, C. Glocker, "Multibody dynamics with unilateral contacts", 1996, ch. 8.
#include <algorithm>
#include <utility>

#include "simulation/events/event_locator.h"

namespace plab::simulation
{
namespace
{

constexpr int kMostRowSearches = 50;
/// kOver: compression is over below this fraction of the first closing speed. kSlides: a contact slides if its tangential speed is above
/// this fraction of the body's speed.
constexpr double kOver = 1e-12, kSlides = 1e-9;
/// Cost of a projection in units of the work budget, for each body of the group.
constexpr double kProjection = 2;

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

/// J.
double EventLocator::kinetic_energy_of_jointed() const
{
    const world::HostTables& host = step_.world.host();
    double sum = 0;
    for (const std::uint32_t b : jointed_.bodies) sum += host.bodies.kinetic_energy(b);
    for (const std::uint32_t s : jointed_.shafts)
        if (host.shafts.dynamic(s)) sum += 0.5 * host.shafts.inertia[s] * host.shafts.speed[s] * host.shafts.speed[s];
    return sum;
}

/// Asks the response which contacts come to rest: it answers the whole impact as if there were no joints, then the velocities are put
/// back. Compression and restitution by themselves would not show it.
void EventLocator::note_resting_contacts()
{
    Jointed& j = jointed_;
    contacts_.respond(impact_, ImpactMode::Impact, 0, {});
    put(j.start);
    j.rests.clear(), j.restitution.clear();
    for (FoundContact& f : impact_)
    {
        j.rests.push_back(f.contact.resting ? 1 : 0), j.restitution.push_back(f.contact.restitution);
        f.contact.restitution = 0;
    }
}

/// Projects the velocities of the jointed groups onto their joints, at `time` (s since the start of the step).
void EventLocator::join(double time)
{
    for (const std::uint32_t g : jointed_.groups)
    {
        motion_.system_for(std::span(&g, 1), {}).begin(time, step_.frame.step, step_.book(), nullptr);
        budget_.spend(kProjection * static_cast<double>(step_.groups.all[g].bodies.size()));
    }
}

double EventLocator::closing() const
{
    double most = 0;
    for (const FoundContact& f : impact_) most = std::max(most, -contacts_.normal_velocity(f.contact));
    return most;
}

void EventLocator::compress_once(double time)
{
    for (FoundContact& f : impact_) f.contact.impulse = {};
    contacts_.respond(impact_, ImpactMode::Impact, 0, step_.book());
    jointed_.last.clear();
    for (std::size_t i = 0; i < impact_.size(); ++i)
    {
        jointed_.last.push_back(impact_[i].contact.impulse);
        jointed_.impulse[i] += impact_[i].contact.impulse;
    }
    join(time);
}

/// Applies `share` times the last impulses. With `of_all`: `share` times the restitution times the sum so far, of which only the normal
/// part counts where the contact does not slide.
void EventLocator::add_impulses(double share, bool of_all)
{
    Bodies& bodies = step_.world.host().bodies;
    for (std::size_t i = 0; i < impact_.size(); ++i)
    {
        const Contact& c = impact_[i].contact;
        const auto slip = [&] { return bodies.velocity_at(c.b.index, c.point) - bodies.velocity_at(c.a.index, c.point); };
        const Vec3 before = slip();
        Vec3 impulse = share * jointed_.last[i];
        if (of_all)
        {
            const Vec3& all = jointed_.impulse[i];
            const Vec3 across = before - c.normal * dot(c.normal, before);
            const bool slides = length(across) > kSlides * length(bodies.velocity_at(c.b.index, c.point));
            impulse = share * jointed_.restitution[i] * (slides ? all : c.normal * dot(c.normal, all));
            jointed_.last[i] = impulse;
        }
        if (impulse == Vec3{}) continue;
        if (bodies.dynamic(c.a.index)) bodies.apply_impulse(c.a.index, -impulse, c.point);
        if (bodies.dynamic(c.b.index)) bodies.apply_impulse(c.b.index, impulse, c.point);
        step_.work[contacts_.detectors()[impact_[i].detector].response] += 0.5 * dot(impulse, before + slip());
        if (!of_all) jointed_.impulse[i] += impulse;
    }
}

/// Compresses until no contact closes any more. Response and projection are linear while no contact switches, so after a first round the
/// remaining closing speed shrinks by a constant factor, and the geometric series can be summed at once. For a single contact that is
/// exact.
void EventLocator::compress(double time)
{
    const double before = closing(), over = kOver * before;
    if (!(before > 0)) return;
    compress_once(time);
    const double left = closing();
    if (left > over && left < before)
    {
        add_impulses(left / (before - left), false);
        join(time);
    }
    for (int round = 0; round < kMostRowSearches && closing() > over; ++round) compress_once(time);
}

/// Poisson's hypothesis: each contact gives back e times the impulse that its compression took.
void EventLocator::apply_restitution(double time)
{
    jointed_.last.resize(impact_.size());
    add_impulses(1, true);
    for (std::size_t i = 0; i < impact_.size(); ++i) jointed_.impulse[i] += jointed_.last[i];
    join(time);
    compress(time);  // the restitution may have pressed bodies against others
}

void EventLocator::answer_jointed(double time)
{
    jointed_.impulse.assign(impact_.size(), Vec3{});
    jointed_.last.assign(impact_.size(), Vec3{});
    compress(time);
    apply_restitution(time);
}

/// Whether a motor, or something whose motion is prescribed, may give energy.
bool EventLocator::is_driven_impact() const
{
    const world::HostTables& host = step_.world.host();
    const auto is_moved = [&](Ref r)
    { return (r.facet == Facet::Body ? host.bodies.motion[r.index] : host.shafts.motion[r.index]) == Motion::Kinematic; };
    const auto is_motor = [&](const ConstraintRow& row)
    {
        return row.rate != 0 ||
               std::any_of(row.blocks.begin(), row.blocks.begin() + row.count, [&](const RowBlock& b) { return is_moved(b.participant); });
    };
    const auto has_motor = [&](std::uint32_t g)
    { return std::ranges::any_of(motion_.system_for(std::span(&g, 1), {}).rows()->rows(), is_motor); };
    return std::ranges::any_of(impact_, [&](const FoundContact& f) { return is_moved(f.contact.a) || is_moved(f.contact.b); }) ||
           std::ranges::any_of(jointed_.groups, has_motor);
}

/// With friction, applying contacts and joints in turn may end with more energy than there was: where the joints turn what friction pushes
/// back at it, it pushes more with each turn, and restitution gives a part of all that. Without friction no energy is made, as both
/// projections are orthogonal. Speeds between the two outcomes satisfy joints and contacts as well, and impulses between them obey
/// Coulomb's law: of these the answer takes those nearest to the outcome with friction that have no more energy than `start` (J).
void EventLocator::answer_without_gain(double time, double start)
{
    constexpr int kHalvings = 40;
    Jointed& j = jointed_;
    const double rough = kinetic_energy_of_jointed();
    keep(j.rough), j.rough_impulse = j.impulse;
    put(j.start);
    j.friction.clear();
    for (FoundContact& f : impact_) j.friction.push_back(std::exchange(f.contact.friction, 0.0));
    answer_jointed(time);
    for (std::size_t i = 0; i < impact_.size(); ++i) impact_[i].contact.friction = j.friction[i];
    Jointed::Speeds& smooth = j.start;  // the start is not needed any more
    keep(smooth);
    const std::vector<Vec3> smooth_impulse = j.impulse;
    const double without = kinetic_energy_of_jointed();
    const auto blend = [&](double share)
    {
        const auto mix = [&](const auto& from, const auto& to) { return from + (to - from) * share; };
        Bodies& bodies = step_.world.host().bodies;
        for (std::size_t i = 0; i < j.bodies.size(); ++i)
        {
            bodies.velocity[j.bodies[i]] = mix(smooth.velocity[i], j.rough.velocity[i]);
            bodies.angular_velocity[j.bodies[i]] = mix(smooth.spin[i], j.rough.spin[i]);
            bodies.angular_momentum[j.bodies[i]] = mix(smooth.momentum[i], j.rough.momentum[i]);
        }
        for (std::size_t i = 0; i < j.shafts.size(); ++i)
            step_.world.host().shafts.speed[j.shafts[i]] = mix(smooth.shaft[i], j.rough.shaft[i]);
        for (std::size_t i = 0; i < impact_.size(); ++i) j.impulse[i] = mix(smooth_impulse[i], j.rough_impulse[i]);
        return kinetic_energy_of_jointed();
    };
    double least = 0, most = 1;
    for (int n = 0; n < kHalvings; ++n)
    {
        const double middle = 0.5 * (least + most);
        (blend(middle) <= start ? least : most) = middle;
    }
    const double now = blend(least);
    // Both answers have been booked from the start on.
    step_.work[contacts_.detectors()[impact_.front().detector].response] += (now - start) - (rough - start) - (without - start);
}

void EventLocator::respond(double time)
{
    if (!find_jointed())
    {
        contacts_.respond(impact_, ImpactMode::Impact, 0, step_.book());
        return;
    }
    constexpr double kRounding = 1e-12;
    keep(jointed_.start);
    const double start = kinetic_energy_of_jointed();
    note_resting_contacts();
    answer_jointed(time);
    if (kinetic_energy_of_jointed() > start * (1 + kRounding) && !is_driven_impact()) answer_without_gain(time, start);
    for (std::size_t i = 0; i < impact_.size(); ++i)
    {
        Contact& c = impact_[i].contact;
        c.restitution = jointed_.restitution[i], c.impulse = jointed_.impulse[i];
        c.resting = jointed_.rests[i] != 0;
    }
}

}  // namespace plab::simulation
