#include "simulation/watch/tunnel_watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulation/contacts/shape_width.h"
#include "simulation/watch/joined_overlaps.h"
#include "simulation/watch/unresisted_rolling.h"

namespace plab::simulation
{

namespace
{

constexpr double kStraight = 0.1;  // relative deviation up to which a displacement counts as speed times step
constexpr double kDeep = 0.5;
constexpr int kDeepSteps = 8;
constexpr double kHalfDiagonal = 0.70710678118654752;

/// Half extents of a box inside the shape, about its origin; negative if the shape has none.
Vec3 box_inside(const Geometry& g)
{
    switch (g.kind)
    {
        case GeometryKind::Box:
            return g.size;
        case GeometryKind::Capsule:
        case GeometryKind::Cylinder:
            return {kHalfDiagonal * g.size.x, kHalfDiagonal * g.size.x, g.size.z};
        default:
            return {-1, -1, -1};
    }
}

bool crosses_ball(const Vec3& a, const Vec3& b, double radius)
{
    const double r2 = radius * radius;
    if (length_squared(a) <= r2 || length_squared(b) <= r2) return false;
    const Vec3 linear = b - a;
    const double t = -dot(a, linear) / length_squared(linear);
    return t > 0 && t < 1 && length_squared(a + linear * t) < r2;
}

/// Slab test: the part of the segment that is inside all three pairs of planes.
bool crosses_box(const Vec3& a, const Vec3& b, const Vec3& half)
{
    const std::array<double, 3> from{a.x, a.y, a.z}, to{b.x, b.y, b.z}, h{half.x, half.y, half.z};
    double enter = 0, leave = 1;
    bool a_inside = true, b_inside = true;
    for (std::size_t k = 0; k < 3; ++k)
    {
        a_inside = a_inside && std::fabs(from[k]) <= h[k];
        b_inside = b_inside && std::fabs(to[k]) <= h[k];
        const double linear = to[k] - from[k];
        if (linear == 0 && std::fabs(from[k]) >= h[k]) return false;
        if (linear == 0) continue;
        const double one = (-h[k] - from[k]) / linear, two = (h[k] - from[k]) / linear;
        enter = std::max(enter, std::min(one, two)), leave = std::min(leave, std::max(one, two));
    }
    return !a_inside && !b_inside && enter < leave;
}

bool crosses(const Vec3& a, const Vec3& b, const Geometry& g)
{
    if (g.kind == GeometryKind::Sphere) return crosses_ball(a, b, g.size.x);
    const Vec3 half = box_inside(g);
    return half.x > 0 && crosses_box(a, b, half);
}

}  // namespace

void TunnelWatch::find_colliding_bodies(const RunView& s)
{
    const world::World& world = s.world;
    const world::HostTables& host = world.host();
    ready_ = true;
    mark_ = nullptr;
    colliding_.clear();
    for (const Detector& d : s.stepper.detectors())
    {
        if (!d.responds && !d.by_rows && !d.by_force) continue;  // a sensor lets bodies pass through
        CollidingBodies colliding{d.component, {}, d.certifies && !d.persists() && !d.adapts};
        for (const Role& role : world.table_of(d.component).schema().roles())
            for (const Ref r : world.participants(d.component, role))
                if (r.facet == Facet::Body) colliding.bodies.push_back(r.index);
        if (colliding.bodies.size() > 1) colliding_.push_back(std::move(colliding));
    }
    memory_.reported.resize(host.bodies.size(), 0);
    start_.resize(host.bodies.size());
    least_width_.assign(host.bodies.size(), std::numeric_limits<double>::infinity());
    for (std::size_t b = 0; b < least_width_.size(); ++b)
        for (const Ref shape : host.bodies.shapes[b])
            least_width_[b] = std::min(least_width_[b], least_half_width(host.shapes.geometry[shape.index]));
    memory_.sinking.resize(host.bodies.size());
    shallow_ = std::numeric_limits<double>::infinity();
    for (const double width : least_width_)
        if (width > 0) shallow_ = std::min(shallow_, kDeep * width);
}

void TunnelWatch::before_step(const RunView& s)
{
    if (!ready_) find_colliding_bodies(s);
    if (colliding_.empty()) return;
    const Bodies& bodies = s.world.host().bodies;
    // Bodies that sleep stay where they were.
    const RestState& rest = s.stepper.contacts().rest();
    if (const std::vector<std::uint32_t>* const some = rest.changing_since(mark_))
        for (const std::uint32_t b : *some) start_[b] = {bodies.position[b], bodies.orientation[b]};
    else
        for (std::size_t b = 0; b < start_.size(); ++b) start_[b] = {bodies.position[b], bodies.orientation[b]};
    mark_ = rest.mark;
}

bool TunnelWatch::passed(const RunView& s, std::uint32_t body, std::uint32_t other) const
{
    const world::HostTables& host = s.world.host();
    const Bodies& bodies = host.bodies;
    const auto straight = [&](std::uint32_t b)
    {
        const Vec3 linear = bodies.position[b] - start_[b].position;
        return length_squared(linear - bodies.velocity[b] * s.dt) <= kStraight * kStraight * length_squared(linear);
    };
    if (!straight(body) || !straight(other)) return false;
    // Positions in the other body's axes about its centre of mass, at the start and at the end of the step.
    const Vec3 from = rotate(conjugate(start_[other].orientation), start_[body].position - start_[other].position) + bodies.center_B[other];
    const Vec3 to = rotate(conjugate(bodies.orientation[other]), bodies.position[body] - bodies.position[other]) + bodies.center_B[other];
    return std::any_of(bodies.shapes[other].begin(), bodies.shapes[other].end(),
                       [&](const Ref shape)
                       {
                           const Geometry& g = host.shapes.geometry[shape.index];
                           const auto in_shape = [&](const Vec3& p) { return rotate(conjugate(g.pose.q), p - g.pose.p); };
                           return crosses(in_shape(from), in_shape(to), g);
                       });
}

/// Computes the boxes that the bodies swept over. Returns false if none moved far enough to pass through another.
bool TunnelWatch::find_swept_boxes(const RunView& s, const CollidingBodies& colliding)
{
    const Bodies& bodies = s.world.host().bodies;
    const std::span<const double> radius = s.stepper.radius_of_body();
    const auto is_fast = [&](std::uint32_t b)
    {
        return bodies.dynamic(b) && memory_.reported[b] == 0 &&
               length_squared(bodies.position[b] - start_[b].position) > least_width_[b] * least_width_[b];
    };
    const std::vector<std::uint32_t>* const some = s.stepper.contacts().rest().changing_since(mark_);
    const std::vector<std::uint32_t>& moving = some ? *some : colliding.bodies;
    if (std::none_of(moving.begin(), moving.end(), is_fast)) return false;
    swept_.assign(colliding.bodies.size(), {});
    bounded_.clear(), fast_.clear();
    for (std::uint32_t i = 0; i < colliding.bodies.size(); ++i)
    {
        const std::uint32_t b = colliding.bodies[i];
        if (!std::isfinite(radius[b])) continue;  // a plane: a body behind it overlaps it
        const Vec3 around{radius[b], radius[b], radius[b]};
        const geometry::Box before{start_[b].position - around, start_[b].position + around};
        swept_[i] = geometry::joined(before, {bodies.position[b] - around, bodies.position[b] + around});
        bounded_.push_back(i);
        if (is_fast(b)) fast_.push_back(i);
    }
    return true;
}

/// Tests exactly what the boxes of fast bodies overlap.
void TunnelWatch::find_tunnelled_pairs(const RunView& s, const CollidingBodies& colliding)
{
    tunnelled_.clear();
    tree_.build(swept_, bounded_);
    for (const std::uint32_t i : fast_)
        tree_.query(swept_[i],
                    [&](std::uint32_t j)
                    {
                        const std::uint32_t a = colliding.bodies[i], b = colliding.bodies[j];
                        if (i != j && !s.world.host().filter.excludes_bodies(a, b) && passed(s, a, b)) tunnelled_.push_back({i, j});
                    });
    std::sort(tunnelled_.begin(), tunnelled_.end());
}

void TunnelWatch::report_tunnelled_pairs(const RunView& s, const CollidingBodies& colliding, std::vector<Event>& events)
{
    const world::World& world = s.world;
    for (const TunnelledPair& p : tunnelled_)
    {
        const std::uint32_t body = colliding.bodies[p.body];
        if (memory_.reported[body] != 0) continue;
        memory_.reported[body] = 1;
        const Ref a{Facet::Body, body}, b{Facet::Body, colliding.bodies[p.other]};
        Event e;
        e.tick = s.tick, e.time = s.time + s.dt, e.kind = "contact.missed", e.severity = Severity::Warning;
        e.component = colliding.detector, e.a = a, e.b = b;
        e.message = world.id_of(a) + " passed through " + world.id_of(b) +
                    " within a step without being detected; a resolution that searches inside the step (Resolution/LocalRoot) or shorter "
                    "steps would detect it";
        e.values = {length(world.host().bodies.position[body] - start_[body].position)};
        events.push_back(std::move(e));
    }
}

void TunnelWatch::after_step(const RunView& s, std::vector<Event>& events)
{
    for (const CollidingBodies& colliding : colliding_)
    {
        if (colliding.certified || !find_swept_boxes(s, colliding)) continue;
        find_tunnelled_pairs(s, colliding);
        report_tunnelled_pairs(s, colliding, events);
    }
    if (!colliding_.empty() && s.stepper.report().deepest > shallow_) find_overlaps(s, events);
    if (s.tick == 0) report_joined_overlaps(s, least_width_, events), report_unresisted_rolling(s, events);
}

namespace
{

/// The first joint between two bodies, by id; kNoIndex if there is none.
std::uint32_t joint_between(const world::World& world, Ref a, Ref b)
{
    for (const std::uint32_t i : world.in_id_order())
    {
        const model::ComponentType* type = world.type_of(i);
        if (!type || !type->info.name.starts_with("Constraint/")) continue;
        bool has_a = false, has_b = false;
        for (const Role& role : world.table_of(i).schema().roles())
            world.for_each_participant(i, role, [&](Ref r) { has_a = has_a || r == a, has_b = has_b || r == b; });
        if (has_a && has_b) return i;
    }
    return kNoIndex;
}

/// What may separate two bodies that remain inside one another.
std::string advice(const world::World& world, Ref a, Ref b)
{
    const std::uint32_t joint = joint_between(world, a, b);
    if (joint == kNoIndex) return "more iterations, shorter steps or Manager/Direct may separate them";
    return world.id_of(joint) + " holds them there; if they are meant to overlap, a Collision/Exclude keeps them from colliding";
}

}  // namespace

void TunnelWatch::find_overlaps(const RunView& s, std::vector<Event>& events)
{
    const world::World& world = s.world;
    const Bodies& bodies = world.host().bodies;
    for (const FoundContact& f : s.stepper.touching())
    {
        const Contact& c = f.contact;
        const Detector& d = s.stepper.detectors()[f.detector];
        if (d.by_force || (!d.responds && !d.by_rows)) continue;
        const double one = least_width_[c.a.index], two = least_width_[c.b.index];
        if (!(c.depth > kDeep * std::min(one > 0 ? one : two, two > 0 ? two : one))) continue;
        const Ref sinks = bodies.dynamic(c.a.index) ? c.a : c.b;
        TunnelMemory::Sinking& sinking = memory_.sinking[sinks.index];
        if (sinking.last == s.tick) continue;
        sinking.steps = sinking.last + 1 == s.tick ? sinking.steps + 1 : 1;
        sinking.last = s.tick;
        if (sinking.steps != kDeepSteps) continue;
        Event e;
        e.tick = s.tick, e.time = s.time + s.dt, e.kind = "contact.deep", e.severity = Severity::Warning;
        e.component = d.component, e.a = c.a, e.b = c.b;
        e.message = world.id_of(c.a) + " and " + world.id_of(c.b) + " remain deep inside one another; " + advice(world, c.a, c.b);
        e.values = {c.depth};
        events.push_back(std::move(e));
    }
}

}  // namespace plab::simulation
