#include "simulation/contacts/contact_book.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "plab/surface.h"
#include "simulation/contacts/contact_rules.h"
#include "simulation/contacts/speculation.h"
#include "simulation/motion/component_call.h"

namespace plab::simulation
{
namespace
{

/// Largest extra margin with which a persistent pair is detected, as a fraction of the smaller body's radius.
constexpr double kMostShare = 0.1;

/// Whether pairs are known, and rest, with one detector as with the other.
bool keep_same_pairs(const Detector& x, const Detector& y)
{
    const auto traits = [](const Detector& d)
    { return std::tuple(d.component, d.responds, d.by_rows, d.by_force, d.speculates || d.adapts, d.response, d.resolution); };
    return traits(x) == traits(y);
}

/// m: radius of the most strongly curved part of a shape, negative for surfaces that are touched from inside; infinite if it has none.
double curve_radius(const Shapes& shapes, std::uint32_t shape)
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
    add(shapes.geometry[shape]);
    for (const std::uint32_t part : shapes.geometry[shape].parts) add(shapes.geometry[part]);
    return least;
}

/// m: radius of the sphere about the origin of a shape's frame that contains it.
double bounding_radius(const Geometry& g)
{
    double r = 0;
    if (g.kind == GeometryKind::Plane) return std::numeric_limits<double>::infinity();
    if (g.kind == GeometryKind::Sphere) r = g.size.x;
    if (g.kind == GeometryKind::Box) r = length(g.size);
    if (g.kind == GeometryKind::Capsule) r = g.size.x + g.size.z;
    if (g.kind == GeometryKind::Cylinder) r = std::hypot(g.size.x, g.size.z);
    for (const Vec3& v : g.vertices) r = std::max(r, length(v));
    return r;
}

/// m: gap that opens between two round bodies because they move straight on for h while they slide along one another. One step opens
/// (v h)^2 / (2 (r_a + r_b)). After it they separate by twice that per step, and forces act against it one step later, so the gap can
/// grow to 8 times as much.
double opening_by_curves(double speed, double h, double radii) { return 4 * speed * speed * h * h / radii; }

/// m: persistence margin of a pair that may slide along a curve, at least `base`. Such a pair is off the curve by a little more than others
/// at the end of a step and must still count as persistent, otherwise it would hop. A pair that separates faster than the curvature
/// explains bounces, and gets `base` only.
/// `curves`, m: sum of the curve radii of both.
double sliding_margin(const Bodies& bodies, Ref a, Ref b, const Vec3& normal, double curves, double base, double radius, double h)
{
    const Vec3 v = bodies.velocity[b.index] - bodies.velocity[a.index];
    const double separation_speed = dot(v, normal), along = length(v - separation_speed * normal);
    if (!(curves > 0) || separation_speed > 2 * along * along * h / curves) return base;
    return base + std::min(opening_by_curves(along, h, curves), kMostShare * radius);
}

}  // namespace

Errors ContactBook::rebuild(bool sizes)
{
    const std::vector<Detector> before = std::exchange(detectors_, find_detectors(step_.world, step_.schedule));
    if (Errors refused = check_contacts(step_.world, detectors_); !refused.empty()) return refused;
    // A cache may be large, and most structural changes are of no concern to it.
    const bool same = std::ranges::equal(before, detectors_, keep_same_pairs);
    if (!same || order_number_ != step_.world.order_number()) cache_.refresh(step_.world, detectors_);
    order_number_ = step_.world.order_number();
    if (imposed_.size() != detectors_.size()) imposed_.clear();
    resting_.forget();
    found_.clear();
    if (sizes || !detectors_.empty()) measure_bodies();
    list_participants();
    return {};
}

void ContactBook::list_participants()
{
    const Bodies& bodies = step_.world.host().bodies;
    participants_.assign(detectors_.size(), {}), seen_in_.assign(detectors_.size(), 0);
    for (std::size_t d = 0; d < detectors_.size(); ++d)
    {
        for (const Role& role : step_.world.tables()[detectors_[d].table]->schema().roles())
        {
            if (!role.many) continue;
            Participants& list = participants_[d].emplace_back();
            list.all = &(*role.many)[detectors_[d].row];
            list.place.assign(bodies.size(), kNoIndex);
            for (std::uint32_t i = 0; i < list.all->size(); ++i)
                if (const Ref r = (*list.all)[i]; r.facet == Facet::Body) list.place[r.index] = i;
        }
        std::sort(participants_[d].begin(), participants_[d].end(),
                  [](const Participants& x, const Participants& y) { return std::less<>()(x.all, y.all); });
    }
}

/// Which of the detector's participants are active: it need not go through all of them.
std::span<const Shortlist> ContactBook::shortlists_of(std::size_t detector, const IndexSet& active)
{
    const std::vector<Participants>& lists = participants_[detector];
    if (shortlists_.size() < lists.size()) shortlists_.resize(lists.size());
    for (std::size_t i = 0; i < lists.size(); ++i)
    {
        short_places_.clear();
        for (const std::uint32_t b : active.members())
            if (lists[i].place[b] != kNoIndex) short_places_.push_back(lists[i].place[b]);
        std::sort(short_places_.begin(), short_places_.end());
        shortlists_[i].all = lists[i].all, shortlists_[i].active.clear();
        for (const std::uint32_t place : short_places_) shortlists_[i].active.push_back((*lists[i].all)[place]);
    }
    return std::span(shortlists_).first(lists.size());
}

/// Many bodies may share a shape, so each shape is measured once.
void ContactBook::measure_bodies()
{
    const world::HostTables& host = step_.world.host();
    std::vector<double> curves(host.shapes.size()), radii(host.shapes.size());
    for (std::uint32_t k = 0; k < curves.size(); ++k)
        curves[k] = curve_radius(host.shapes, k), radii[k] = bounding_radius(host.shapes.geometry[k]);
    curve_radius_of_body_.assign(host.bodies.size(), HUGE_VAL), radius_of_body_.assign(host.bodies.size(), 0.0);
    for (std::size_t b = 0; b < radius_of_body_.size(); ++b)
        for (const Ref shape : host.bodies.shapes[b])
        {
            double& curve = curve_radius_of_body_[b];
            if (std::fabs(curves[shape.index]) < std::fabs(curve)) curve = curves[shape.index];
            const Geometry& g = host.shapes.geometry[shape.index];
            radius_of_body_[b] = std::max(radius_of_body_[b], length(g.pose.p - host.bodies.center_B[b]) + radii[shape.index]);
        }
}

void ContactBook::query(const Detector& detector, ContactSink& sink, const IndexSet* active)
{
    const auto index = static_cast<std::size_t>(&detector - detectors_.data());
    ComponentCall question(step_, *step_.world.tables()[detector.table], detector.row);
    question.call.contacts = &sink;
    step_.report.looked_at += active ? active->members().size() : step_.world.host().bodies.size();
    if (active)
        question.context.active_bodies = active->flags(), question.context.shortlists = shortlists_of(index, *active);
    else
        seen_in_[index] = step_.serial;
    const CostScope scope(step_.meter, step_.meter.of_component(detector.component));
    step_.meter.ran(detector.table, Phase::Detect);
    if (const auto done = question.run(*detector.command); !done)
        question.context.emit(detector.row, "detection.failed", Severity::Failure, done.error().reason);
}

void ContactBook::detect(const Detector& detector, std::uint32_t index, std::span<const PersistentPair> persistent, bool only_persistent,
                         std::vector<FoundContact>& out, double margin)
{
    ContactCollector sink(step_.world, out);
    sink.begin_query(index, persistent, only_persistent, margin);
    const bool some = only_persistent && seen_in_[index] == step_.serial;
    asked_.begin(step_.world.host().bodies.size());
    if (some)
        for (const PersistentPair& p : persistent) asked_.add(p.a.index), asked_.add(p.b.index);
    query(detector, sink, some ? &asked_ : nullptr);
    step_.report.further_pairs += sink.further_pairs();
}

void ContactBook::detect_all(std::vector<FoundContact>& out)
{
    out.clear();
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        if (detectors_[d].by_rows && detectors_[d].persists())
        {
            detect_with_gaps(d, out);
            continue;
        }
        persistent_.clear();
        double margin = 0;
        for (const PairState& p : cache_.pairs())
            if (p.resting && p.detector == detectors_[d].component)
                persistent_.push_back({p.a, p.b, {}}), margin = std::max(margin, persistence_margin(p));
        const std::size_t first = out.size();
        detect(detectors_[d], d, persistent_, false, out, margin);
        // A detection pass has one margin, the largest of all persistent pairs. Gaps count for persistent pairs only, each up to its own
        // margin, so the others are dropped again.
        const auto far = [&](const FoundContact& f)
        {
            if (f.contact.depth > 0) return false;
            const PairState* pair = find_pair(f);
            return !pair || !pair->resting || f.contact.depth <= -persistence_margin(*pair);
        };
        out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), far), out.end());
    }
    sort_contacts(out, step_.world);
}

/// Contacts of a detector whose pairs are persistent as soon as they touch. Includes gaps up to the persistence margin, gaps that may close
/// within the step (speculative contacts), and, for pairs that pressed, gaps that curvature opens.
void ContactBook::detect_with_gaps(std::uint32_t index, std::vector<FoundContact>& out)
{
    const Detector& detector = detectors_[index];
    const Bodies& bodies = step_.world.host().bodies;
    double margin = 0, fastest = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) fastest = std::max(fastest, length(bodies.velocity[b]));
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        if (!bodies.dynamic(b) || !std::isfinite(radius_of_body_[b])) continue;
        // The other body may be round as well, with any radius.
        const double opens = opening_by_curves(2 * fastest, step_.frame.step, curve_radius_of_body_[b]);
        margin = std::max(margin, kPersistenceShare * radius_of_body_[b] + std::min(opens, kMostShare * radius_of_body_[b]));
    }
    const double acceleration = detector.speculation_acceleration.value_or(0);
    if (detector.speculates) margin = std::max(margin, speculative_margin(bodies, radius_of_body_, acceleration, step_.frame.step));
    const std::size_t first = out.size();
    detect(detector, index, {}, false, out, margin);
    // Use the detected normal, not the stored one: this detection serves the next step as well, and it has to give the same result in a
    // step that starts from a snapshot, where the stored normal may differ.
    std::size_t near = 0;
    const auto margin_of = [&](const Contact& c)
    {
        const PairState* pair = std::as_const(cache_).find(detector.component, c.a, c.b, step_.world, near);
        const double base = persistence_margin(c.a, c.b), radius = std::min(radius_of_body_[c.a.index], radius_of_body_[c.b.index]);
        if (!pair || !pressed(*pair) || !std::isfinite(radius)) return base;
        return sliding_margin(bodies, c.a, c.b, c.normal, curves_of(c.a, c.b), base, radius, step_.frame.step);
    };
    const auto far = [&](const FoundContact& f)
    {
        if (f.contact.depth > 0 || f.contact.depth > -margin_of(f.contact)) return false;
        return !detector.speculates || !may_close(bodies, radius_of_body_, f.contact, acceleration, step_.frame.step);
    };
    out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), far), out.end());
}

KnownContact& ContactBook::known_contact(const FoundContact& f) { return cache_.contact_of(*find_pair(f), f.contact.feature); }

void ContactBook::warm_start(std::span<FoundContact> contacts, bool trial)
{
    for (FoundContact& f : contacts) f.contact.impulse = known_contact(f).warm_start(trial);
}

PairState* ContactBook::find_pair(const FoundContact& f)
{
    return cache_.find(detectors_[f.detector].component, f.contact.a, f.contact.b, step_.world);
}

/// m: gaps of a persistent pair up to this may close within h (s). Corners that rotate towards the other body become contacts before they
/// penetrate it.
double ContactBook::gap_margin(const PairState& pair, double h) const
{
    const double margin = closing_margin(step_.world.host().bodies, radius_of_body_, pair.a, pair.b, pair.normal, h);
    return margin > persistence_margin(pair) ? margin : 0.0;
}

/// A detection pass has one margin for all pairs: drops contacts beyond the margin of their own pair.
void ContactBook::drop_far(std::vector<FoundContact>& out, double h) const
{
    const Bodies& bodies = step_.world.host().bodies;
    std::size_t near = 0;
    const auto far = [&](const FoundContact& f)
    {
        if (f.contact.depth > 0) return false;
        const std::uint32_t detector = detectors_[f.detector].component;
        const PairState* pair = cache_.find(detector, f.contact.a, f.contact.b, step_.world, near);
        const double margin = pair ? persistence_margin(*pair) : persistence_margin(f.contact.a, f.contact.b);
        return f.contact.depth <= -margin && !may_close(bodies, radius_of_body_, f.contact, 0, h);
    };
    out.erase(std::remove_if(out.begin(), out.end(), far), out.end());
}

void ContactBook::touching_pairs_of(std::span<const std::uint32_t> groups, std::vector<FoundContact>& out, double h)
{
    resting_.find(groups, places_);
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        persistent_.clear();
        double margin = 0;
        for (const std::uint32_t place : places_)
        {
            const PairState& p = std::as_const(cache_).pairs()[place];
            if (p.detector != detectors_[d].component) continue;
            persistent_.push_back({p.a, p.b, {}});
            margin = std::max({margin, persistence_margin(p), gap_margin(p, h)});
        }
        if (!persistent_.empty()) detect(detectors_[d], d, persistent_, true, out, margin);
    }
    drop_far(out, h);
    sort_contacts(out, step_.world);
    for (FoundContact& f : out)
    {
        f.contact.resting = true;
        const KnownContact& known = known_contact(f);
        f.contact.id = known.id, f.contact.impulse = known.impulse;
        f.contact.depth -= known.rest_depth;  // overlap left by a swapped-out spring is removed gradually
        fill_material(f);
    }
}

double ContactBook::persistence_margin(const PairState& pair) const
{
    const double base = persistence_margin(pair.a, pair.b), radius = std::min(radius_of_body_[pair.a.index], radius_of_body_[pair.b.index]);
    if (!pressed(pair) || !std::isfinite(radius)) return base;
    return sliding_margin(step_.world.host().bodies, pair.a, pair.b, pair.normal, curves_of(pair.a, pair.b), base, radius,
                          step_.frame.step);
}

double ContactBook::persistence_margin(Ref a, Ref b) const
{
    const double radius = std::min(radius_of_body_[a.index], radius_of_body_[b.index]);
    return std::isfinite(radius) ? kPersistenceShare * radius : 0.0;
}

double ContactBook::normal_velocity(const Contact& c) const
{
    const Bodies& bodies = step_.world.host().bodies;
    return dot(bodies.velocity_at(c.b.index, c.point) - bodies.velocity_at(c.a.index, c.point), c.normal);
}

bool ContactBook::is_of_pair(const FoundContact& f, const PairState& pair) const
{
    return detectors_[f.detector].component == pair.detector && f.contact.a == pair.a && f.contact.b == pair.b;
}

std::size_t ContactBook::first_of_pair(const PairState& pair, std::size_t from) const
{
    // Mostly there is nothing between the contacts of two pairs.
    if (from >= found_.size() || is_of_pair(found_[from], pair)) return from;
    // Both lists are sorted by detector, a and b, so one pass serves all pairs.
    const PairKey wanted(step_.world, pair.detector, pair.a, pair.b);
    const auto key = [&](const FoundContact& f)
    { return PairKey(step_.world, detectors_[f.detector].component, f.contact.a, f.contact.b); };
    while (from < found_.size() && key(found_[from]) < wanted) ++from;
    return from;
}

}  // namespace plab::simulation
