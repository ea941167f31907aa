// Contacts inside a step: looking for them, impulses, who stands with whom.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "plab/rotation.h"
#include "plab/surface.h"
#include "simulation/contacts/island_step.h"
#include "simulation/events/speculation.h"
#include "simulation/step/stepper.h"

namespace plab::simulation
{
namespace
{

/// Of the smaller body's radius: a standing pair is never looked at as if it were closer than this.
constexpr double kMostShare = 0.1;

/// m: radius of the most curved round shape of a body, negative of what is touched from inside; infinite where it has none.
double curve_radius(const Bodies& bodies, const Shapes& shapes, std::uint32_t b)
{
    double least = HUGE_VAL;
    const auto add = [&](const Geometry& g)
    {
        const bool round = g.kind == GeometryKind::Sphere || g.kind == GeometryKind::Capsule || g.kind == GeometryKind::Cylinder;
        if (round && g.size.x < std::fabs(least)) least = g.size.x;
        const Surface surface = surface_of(g);
        const bool inside = surface == Surface::Bore || surface == Surface::Bowl;
        if (inside && surface_radius(g) < std::fabs(least)) least = -surface_radius(g);
    };
    for (const Ref shape : bodies.shapes[b])
    {
        const Geometry& g = shapes.geometry[shape.index];
        add(g);
        for (const std::uint32_t part : g.parts) add(shapes.geometry[part]);
    }
    return least;
}

const PairState* known_pair(const ContactCache& cache, const world::World& world, std::uint32_t detector, const Contact& c)
{
    const auto key = [&](std::uint32_t d, Ref a, Ref b) { return std::tuple(world.rank(d), world.rank(a), world.rank(b)); };
    const auto at = std::lower_bound(cache.pairs().begin(), cache.pairs().end(), key(detector, c.a, c.b),
                                     [&](const PairState& p, const auto& k) { return key(p.detector, p.a, p.b) < k; });
    return at != cache.pairs().end() && at->detector == detector && at->a == c.a && at->b == c.b ? &*at : nullptr;
}

/// m: by how much two round bodies part while they slide along one another straight on for h: (v h)^2 / (2 (r_a + r_b)) in one step.
/// That leaves them parting at twice this per step, and forces, which take it back, act a step later: up to 8 times as much.
double opening_by_curves(double speed, double h, double radii) { return 4 * speed * speed * h * h / radii; }

/// m, beyond `base`: what slides along a curve is off it by a little more than others at the end of a step, and still held: without, it
/// would hop. Not what parts faster than the curve makes it: that bounces.
double sliding_margin(const world::HostTables& host, Ref a, Ref b, const Vec3& normal, double base, double radius, double h)
{
    const Vec3 v = host.bodies.velocity[b.index] - host.bodies.velocity[a.index];
    const double parting = dot(v, normal), along = length(v - parting * normal);
    const double curves = std::fabs(curve_radius(host.bodies, host.shapes, a.index) + curve_radius(host.bodies, host.shapes, b.index));
    if (!(curves > 0) || parting > 2 * along * along * h / curves) return base;
    return base + std::min(opening_by_curves(along, h, curves), kMostShare * radius);
}

}  // namespace

void Stepper::detect(const Detector& detector, std::uint32_t index, std::span<const StandingPair> standing, bool only_standing,
                     std::vector<FoundContact>& out, double margin)
{
    world::Table& table = *world_.tables()[detector.table];
    StepContext context;
    context.time = frame_.start_time, context.dt = frame_.step, context.tick = frame_.tick, context.events = this;
    context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
    ContactCollector sink(world_, out);
    sink.look_for(index, standing, only_standing, margin);
    PhaseCall call;
    call.context = &context, call.rows = Rows(&detector.row, 1);
    call.bodies = &world_.host().bodies, call.shafts = &world_.host().shafts, call.shapes = &world_.host().shapes;
    call.contacts = &sink;
    const CostScope scope(meter_, meter_.of_component(detector.component));
    meter_.ran(detector.table, Phase::Detect);
    const auto done = detector.command->run(call, table.rows());
    report_.further_pairs += sink.further_pairs();
    if (!done) context.emit(detector.row, "detection.failed", Severity::Failure, done.error().reason);
}

void Stepper::detect_all(std::vector<FoundContact>& out)
{
    out.clear();
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        if (detectors_[d].by_rows && detectors_[d].persists())
        {
            detect_with_gaps(d, out);
            continue;
        }
        standing_.clear();
        double margin = 0;
        for (const PairState& p : cache_.pairs())
            if (p.resting && p.detector == detectors_[d].component)
                standing_.push_back({p.a, p.b, {}}), margin = std::max(margin, standing_margin(p));
        const std::size_t first = out.size();
        detect(detectors_[d], d, standing_, false, out, margin);
        // One look has one margin, that of the widest standing pair: gaps count for standing pairs only, each up to its own.
        const auto far = [&](const FoundContact& f)
        {
            if (f.contact.depth > 0) return false;
            const PairState* pair = cache_.find(detectors_[f.detector].component, f.contact.a, f.contact.b, world_);
            return !pair || !pair->resting || f.contact.depth <= -standing_margin(*pair);
        };
        out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), far), out.end());
    }
    sort_contacts(out, world_);
}

/// Contacts of pairs that stand as soon as they touch: with the gaps that count as touching, or may close within the step, and, of pairs
/// that pressed, those that curves open.
void Stepper::detect_with_gaps(std::uint32_t index, std::vector<FoundContact>& out)
{
    const Detector& detector = detectors_[index];
    const Bodies& bodies = world_.host().bodies;
    double margin = 0, fastest = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) fastest = std::max(fastest, length(bodies.velocity[b]));
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        if (!bodies.dynamic(b) || !std::isfinite(radius_of_body_[b])) continue;
        // The other one is round, too, of any radius.
        const double opens = opening_by_curves(2 * fastest, frame_.step, curve_radius(bodies, world_.host().shapes, b));
        margin = std::max(margin, kStandingShare * radius_of_body_[b] + std::min(opens, kMostShare * radius_of_body_[b]));
    }
    const double acceleration = detector.speculates ? number_of(detector.resolution, "acceleration") : 0.0;
    if (detector.speculates) margin = std::max(margin, speculative_margin(bodies, radius_of_body_, acceleration, frame_.step));
    const std::size_t first = out.size();
    detect(detector, index, {}, false, out, margin);
    // By the normal that is seen, not the one that is known: this look serves the next step as well, and a step that begins from a
    // snapshot looks with other knowledge.
    const auto margin_of = [&](const Contact& c)
    {
        const PairState* pair = known_pair(cache_, world_, detector.component, c);
        const double base = standing_margin(c.a, c.b), radius = std::min(radius_of_body_[c.a.index], radius_of_body_[c.b.index]);
        if (!pair || !pressed(*pair) || !std::isfinite(radius)) return base;
        return sliding_margin(world_.host(), c.a, c.b, c.normal, base, radius, frame_.step);
    };
    const auto far = [&](const FoundContact& f)
    {
        if (f.contact.depth > -margin_of(f.contact)) return false;
        return !detector.speculates || !may_close(bodies, radius_of_body_, f.contact, acceleration, frame_.step);
    };
    out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), far), out.end());
}

/// A parameter of a component; 0 where it has none of that name.
double Stepper::number_of(std::uint32_t component, const char* parameter) const
{
    const Field* field = world_.table_of(component).schema().find_field(parameter);
    const auto* column = field ? dynamic_cast<const Column<double>*>(field->column) : nullptr;
    return column ? (*column)[world_.component(component).row] : 0.0;
}

/// What is remembered of a contact of a known pair.
KnownContact& Stepper::known_contact(const FoundContact& f)
{
    return cache_.contact_of(*cache_.find(detectors_[f.detector].component, f.contact.a, f.contact.b, world_), f.contact.feature);
}

/// m: gaps of a standing pair up to this may close within h: corners that come round are held before they are through.
double Stepper::gap_margin(const PairState& pair, double h) const
{
    const double margin = closing_margin(world_.host().bodies, radius_of_body_, pair.a, pair.b, pair.normal, h);
    return margin > standing_margin(pair) ? margin : 0.0;
}

/// One look has one margin: drops what was seen beyond that of its own pair.
void Stepper::drop_far(std::vector<FoundContact>& out, double h) const
{
    const Bodies& bodies = world_.host().bodies;
    const auto far = [&](const FoundContact& f)
    {
        const PairState* pair = known_pair(cache_, world_, detectors_[f.detector].component, f.contact);
        const double margin = pair ? standing_margin(*pair) : standing_margin(f.contact.a, f.contact.b);
        return f.contact.depth <= -margin && !may_close(bodies, radius_of_body_, f.contact, 0, h);
    };
    out.erase(std::remove_if(out.begin(), out.end(), far), out.end());
}

/// Of standing pairs with a member in `groups`, with the gaps that may close within `h` (s).
void Stepper::touching_pairs_of(std::span<const std::uint32_t> groups, std::vector<FoundContact>& out, double h)
{
    const auto member = [&](Ref r)
    {
        const std::uint32_t g = groups_.of(r);
        return g != kNoIndex && std::binary_search(groups.begin(), groups.end(), g);
    };
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        standing_.clear();
        double margin = 0;
        for (const PairState& p : cache_.pairs())
        {
            if (!p.resting || p.detector != detectors_[d].component || !(member(p.a) || member(p.b))) continue;
            standing_.push_back({p.a, p.b, {}});
            margin = std::max({margin, standing_margin(p), gap_margin(p, h)});
        }
        if (!standing_.empty()) detect(detectors_[d], d, standing_, true, out, margin);
    }
    drop_far(out, h);
    sort_contacts(out, world_);
    for (FoundContact& f : out)
    {
        f.contact.resting = true;
        const KnownContact& known = known_contact(f);
        f.contact.id = known.id, f.contact.impulse = known.impulse;
        f.contact.depth -= known.rest_depth;  // what a swap from a spring left is taken out by and by
        fill_material(f);
    }
}

void Stepper::fill_material(FoundContact& f) const
{
    const world::HostTables& host = world_.host();
    const std::uint32_t ma = host.bodies.material[f.contact.a.index], mb = host.bodies.material[f.contact.b.index];
    if (const SurfaceLaw* law = ma != 0 && mb != 0 ? host.materials.find_pair(ma, mb) : nullptr)
    {
        f.contact.friction = law->friction, f.contact.restitution = law->restitution;
        return;
    }
    const SurfaceLaw law = response_law(f.detector);
    f.contact.friction = law.friction, f.contact.restitution = law.restitution;
}

/// Where no Material/Pair says otherwise.
SurfaceLaw Stepper::response_law(std::uint32_t detector) const
{
    const std::uint32_t response = detectors_[detector].response;
    if (response == kNoIndex) return {};
    return {number_of(response, "friction"), number_of(response, "restitution")};
}

double Stepper::standing_margin(const PairState& pair) const
{
    const double base = standing_margin(pair.a, pair.b), radius = std::min(radius_of_body_[pair.a.index], radius_of_body_[pair.b.index]);
    if (!pressed(pair) || !std::isfinite(radius)) return base;
    return sliding_margin(world_.host(), pair.a, pair.b, pair.normal, base, radius, frame_.step);
}

double Stepper::standing_margin(Ref a, Ref b) const
{
    const double radius = std::min(radius_of_body_[a.index], radius_of_body_[b.index]);
    return std::isfinite(radius) ? kStandingShare * radius : 0.0;
}

double Stepper::normal_velocity(const Contact& c) const
{
    const Bodies& bodies = world_.host().bodies;
    return dot(bodies.velocity_at(c.b.index, c.point) - bodies.velocity_at(c.a.index, c.point), c.normal);
}

double Stepper::kinetic_energy(const std::vector<FoundContact>& contacts) const
{
    const Bodies& bodies = world_.host().bodies;
    counted_.clear();
    for (const FoundContact& f : contacts) counted_.push_back(f.contact.a.index), counted_.push_back(f.contact.b.index);
    std::sort(counted_.begin(), counted_.end());
    counted_.erase(std::unique(counted_.begin(), counted_.end()), counted_.end());
    double sum = 0;
    for (const std::uint32_t b : counted_) sum += bodies.kinetic_energy(b);
    return sum;
}

void Stepper::respond(std::vector<FoundContact>& contacts, ImpactMode mode, double dt, WorkBook book)
{
    // Each detector's own response answers for its contacts. Several detectors are answered in id order.
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        if (!detectors_[d].responds) continue;
        impact_contacts_.clear();
        for (const FoundContact& f : contacts)
            if (f.detector == d) impact_contacts_.push_back(f.contact);
        if (impact_contacts_.empty()) continue;
        const std::uint32_t response = detectors_[d].response;
        world::Table& table = world_.table_of(response);
        const world::Component& c = world_.component(response);
        StepContext context;
        context.time = frame_.start_time, context.dt = dt, context.tick = frame_.tick, context.events = this;
        context.interruption = frame_.interruption;
        context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
        Impact impact;
        impact.mode = mode, impact.dt = dt, impact.contacts = impact_contacts_;
        PhaseCall call;
        call.context = &context, call.rows = Rows(&c.row, 1);
        call.bodies = &world_.host().bodies, call.impact = &impact;
        const double before = book.work ? kinetic_energy(contacts) : 0.0;
        meter_.enter(meter_.of_component(response));
        meter_.ran(c.table, Phase::Respond);
        for (const CommandInfo& command : table.type().info.commands)
            if (command.phase == Phase::Respond && command.run) (void)command.run(call, table.rows());
        meter_.leave();
        if (book.work) book_impact(response, contacts, mode, kinetic_energy(contacts) - before, book);
        report_.worst_residual = std::max(report_.worst_residual, impact.residual);
        report_.swept_rows += 3 * (impact_contacts_.size() + static_cast<std::size_t>(impact.visits));
        std::size_t next = 0;
        for (FoundContact& f : contacts)
            if (f.detector == d) f.contact = impact_contacts_[next++];
    }
}

/// An impact takes energy, or keeps it, where nobody is moved as told.
void Stepper::book_impact(std::uint32_t response, const std::vector<FoundContact>& contacts, ImpactMode mode, double work, WorkBook book)
{
    constexpr double kRounding = 1e-9;
    (*book.work)[response] += book.sign * work;
    if (mode != ImpactMode::Impact || !(work > kRounding * kinetic_energy(contacts))) return;
    const Bodies& bodies = world_.host().bodies;
    for (const FoundContact& f : contacts)
        if (bodies.motion[f.contact.a.index] == Motion::Kinematic || bodies.motion[f.contact.b.index] == Motion::Kinematic) return;
    (*book.work)[response] -= book.sign * work;
    contact_energy_[response].made += book.sign * work;
}

void Stepper::advance_contacts(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows, double from, double to,
                               WorkBook book, bool trial)
{
    islands_.reset(groups_.all.size());
    for (const PairState& p : cache_.pairs())
        if (p.resting && world_.host().bodies.dynamic(p.a.index) && world_.host().bodies.dynamic(p.b.index))
            islands_.join(groups_.of(p.a), groups_.of(p.b));
    if (extra_) forces_.join(islands_);
    contact_groups_.assign(groups.begin(), groups.end());
    held_->take(contact_groups_, islands_);
    if (held_->holds_any()) held_->advance(shadows, islands_, from, to, book, trial);
    // Islands in the order of their first group; members keep their order.
    done_.assign(groups_.all.size(), 0);
    for (const std::uint32_t first : contact_groups_)
    {
        if (done_[first]) continue;
        island_.clear();
        for (const std::uint32_t g : contact_groups_)
            if (!done_[g] && islands_.find(g) == islands_.find(first)) done_[g] = 1, island_.push_back(g);
        std::sort(island_.begin(), island_.end());
        advance_island(island_, shadows, from, to, book, trial);
    }
}

}  // namespace plab::simulation
