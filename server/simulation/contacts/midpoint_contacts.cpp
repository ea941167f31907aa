#include "simulation/contacts/midpoint_contacts.h"

#include <algorithm>
#include <tuple>

#include "plab/rotation.h"

namespace plab::simulation
{
namespace
{

/// In units of the smaller body's radius: a body that moves less than this along a curve in a step leaves it by at most 2^-27 of the
/// radius, so the midpoint is not needed.
constexpr double kNoDisplacement = 0x1p-13;
/// Cosine of the largest angle between a normal at the start and at the midpoint; beyond it the two belong to different surfaces.
constexpr double kSameCurve = 0.9;
/// A contact on a smooth curve returns the speed at which the bodies close along the normal of the midpoint, but for terms of third order.
/// More would be a fold of a surface, at which bodies end along the new side: its speed back would be energy from nothing.
constexpr double kCurves = 1 + 0x1p-6;

/// m/s: of a point that moves with a body; zero for bodies at rest.
Vec3 speed_at(const Bodies& bodies, Ref body, const Vec3& point)
{
    return bodies.motion[body.index] == Motion::Static ? Vec3{} : bodies.velocity_at(body.index, point);
}

}  // namespace

bool MidpointContacts::is_driven(const Contact& c) const
{
    const Bodies& bodies = step_.world.host().bodies;
    return bodies.motion[c.a.index] == Motion::Kinematic || bodies.motion[c.b.index] == Motion::Kinematic;
}

bool MidpointContacts::turns(const Contact& c, double h) const
{
    if (!contacts_.is_round(c.a) || !contacts_.is_round(c.b)) return false;
    const Bodies& bodies = step_.world.host().bodies;
    const Vec3 v = bodies.velocity[c.b.index] - bodies.velocity[c.a.index];
    const double along = length(v - c.normal * dot(v, c.normal));
    return along * h > kNoDisplacement * contacts_.smaller_radius(c.a, c.b);
}

void MidpointContacts::advance_to_midpoint(GroupSystem& system, std::span<const std::uint32_t> members, double h)
{
    const Bodies& bodies = step_.world.host().bodies;
    const std::span<double> x = system.coordinates();
    displacements_.resize(bodies.size());
    for (const std::uint32_t i : members)
    {
        const std::uint32_t b = system.bodies()[i];
        const Vec3 displacement = bodies.velocity[b] * (0.5 * h);
        const Vec3 turn = rotate_back(bodies.orientation[b], bodies.angular_velocity[b]) * (0.5 * h);
        advanced_.push_back({b, displacement, bodies.orientation[b]});
        displacements_[b] = displacement;
        std::copy_n(&displacement.x, 3, &x[6 * i]), std::copy_n(&turn.x, 3, &x[6 * i + 3]);
    }
}

/// m: the gap that a contact may have at the midpoint: what it has now, what its bodies separate by, and what curvature opens, which is
/// less than displacement^2 / 2r.
double MidpointContacts::margin_of(const Contact& c) const
{
    const Vec3 displacement = displacement_of(c.b) - displacement_of(c.a);
    const double radius = contacts_.smaller_radius(c.a, c.b), opens = radius > 0 ? dot(displacement, displacement) / (2 * radius) : 0.0;
    return std::max(0.0, -c.depth) + std::max(0.0, dot(displacement, c.normal)) + opens + contacts_.overlap_tolerance(c.a, c.b);
}

/// Detects the same pairs at the midpoint.
void MidpointContacts::query(std::span<const std::uint32_t> places, const std::vector<FoundContact>& all)
{
    midpoint_.clear();
    for (std::size_t i = 0; i < places.size();)
    {
        const std::uint32_t detector = all[places[i]].detector;
        double margin = 0;
        persistent_.clear();
        for (; i < places.size() && all[places[i]].detector == detector; ++i)
        {
            const Contact& c = all[places[i]].contact;
            if (persistent_.empty() || persistent_.back().a != c.a || persistent_.back().b != c.b) persistent_.push_back({c.a, c.b, {}});
            margin = std::max(margin, margin_of(c));
        }
        contacts_.detect(contacts_.detectors()[detector], detector, persistent_, true, midpoint_, margin);
    }
    sort_contacts(midpoint_, step_.world);
    for (FoundContact& f : midpoint_)
    {
        const Contact& c = f.contact;
        const std::uint32_t detector = contacts_.detectors()[f.detector].component;
        if (const KnownContact* known = contacts_.cache().find_contact(detector, c.a, c.b, c.feature, step_.world))
            f.contact.depth -= known->rest_depth;
    }
}

void MidpointContacts::update_contacts(std::span<const std::uint32_t> places, std::vector<FoundContact>& all, double h)
{
    Bodies& bodies = step_.world.host().bodies;
    for (const Advanced& moved : advanced_)
    {
        bodies.orientation[moved.body] = moved.start;
        bodies.refresh_spin(moved.body);
    }
    query(places, all);
    const auto key = [&](const FoundContact& f)
    { return std::tuple(f.detector, step_.world.rank(f.contact.a), step_.world.rank(f.contact.b), f.contact.feature); };
    for (const std::uint32_t place : places)
    {
        Contact& c = all[place].contact;
        c.pivot = {};  // a manager would put the point midway once more
        const auto found = std::lower_bound(midpoint_.begin(), midpoint_.end(), key(all[place]),
                                            [&](const FoundContact& f, const auto& wanted) { return key(f) < wanted; });
        // One margin serves all pairs of the query. What others need must not decide about this contact, or it would go another way when
        // its island is advanced alone.
        const bool same = found != midpoint_.end() && key(*found) == key(all[place]) && dot(found->contact.normal, c.normal) > kSameCurve &&
                          found->contact.depth >= -margin_of(c);
        if (!same)
        {
            // Not found at the midpoint: keep the normal, and let the contact point move with the advanced bodies.
            const Vec3 a = displacement_of(c.a), b = displacement_of(c.b);
            c.point += bodies.dynamic(c.a.index) && bodies.dynamic(c.b.index) ? (a + b) * 0.5 : a + b;
            continue;
        }
        const double opened = c.depth - found->contact.depth - dot(displacement_of(c.b) - displacement_of(c.a), c.normal);
        c.normal = found->contact.normal, c.point = found->contact.point;
        const double closing = std::max(0.0, dot(speed_at(bodies, c.a, c.point) - speed_at(bodies, c.b, c.point), c.normal));
        c.turning = std::min(-4 * opened / h, kCurves * closing);
    }
}

void MidpointContacts::take_back()
{
    Bodies& bodies = step_.world.host().bodies;
    for (const Advanced& moved : advanced_) bodies.position[moved.body] -= moved.displacement, displacements_[moved.body] = {};
    advanced_.clear();
}

}  // namespace plab::simulation
