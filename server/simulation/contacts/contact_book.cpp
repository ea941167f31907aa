#include "simulation/contacts/contact_book.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

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

/// Keeps the contacts of one detector for which `counts` is true, and lists the pairs.
template <class Counts>
class SelectingCollector final : public ContactCollector
{
public:
    /// `detector`: component.
    SelectingCollector(const world::World& world, std::uint32_t detector, std::vector<FoundContact>& out, std::vector<FoundRun>& runs,
                       const Counts& counts)
        : ContactCollector(world, out), detector_(detector), first_(out.size()), runs_(runs), counts_(counts)
    {
    }
    void add(const Contact& contact) override
    {
        if (!counts_(contact)) return;
        const FoundContact& f = put(contact);
        if (out_->size() > first_ + 1 && same_pair(f, *(&f - 1)))
            in_order_ = in_order_ && (&f - 1)->contact.feature <= contact.feature;
        else
            begin_run(contact);
        ++runs_.back().end;
    }

private:
    void begin_run(const Contact& contact)
    {
        const PairKey key(*world_, detector_, contact.a, contact.b);
        in_order_ = in_order_ && (runs_.empty() || runs_.back().key < key);
        const auto at = static_cast<std::uint32_t>(out_->size() - 1);
        runs_.push_back({at, at, key});
    }

    std::uint32_t detector_;
    std::size_t first_;
    std::vector<FoundRun>& runs_;
    const Counts& counts_;
};

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

Errors ContactBook::rebuild(bool sizes, bool only_solvers)
{
    const std::vector<Detector> before = std::exchange(detectors_, find_detectors(step_.world, step_.schedule));
    const std::optional<world::Revisions> last = std::exchange(built_from_, std::nullopt);
    const world::Revisions now = step_.world.revisions();
    if (Errors refused = check_contacts(step_.world, detectors_); !refused.empty()) return refused;
    // A cache may be large, and most structural changes are of no concern to it.
    const bool same = std::ranges::equal(before, detectors_, keep_same_pairs);
    if (!same || !last || last->order != now.order) cache_.refresh(step_.world, detectors_);
    const bool no_news = last && now.keeps_contacts_since(*last);
    keeps_found_ = same && no_news && !awake_ && !adapts();
    if (imposed_ && imposed_->of.size() != detectors_.size()) imposed_.reset();
    crowded_.clear();
    resting_.forget();
    if (!keeps_found_) found_.clear(), runs_.clear(), ++found_revision_;
    has_sizes_ = has_sizes_ && last && now.keeps_bodies_since(*last);
    if ((sizes || !detectors_.empty()) && !std::exchange(has_sizes_, true)) measure_bodies();
    if (!only_solvers || !same) list_participants();
    detect_among(nullptr), detect_all_once();
    built_from_ = now;
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

bool ContactBook::takes_part(std::uint32_t detector, std::uint32_t body) const
{
    const auto& lists = participants_[detector];
    return std::any_of(lists.begin(), lists.end(), [&](const Participants& l) { return l.place[body] != kNoIndex; });
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

void ContactBook::query(const Detector& detector, ContactSink& sink, const IndexSet* active)
{
    const auto index = static_cast<std::size_t>(&detector - detectors_.data());
    if (!active || active == awake_) seen_in_[index] = step_.serial;
    if (!active) active = part_;
    ComponentCall question(step_, *step_.world.tables()[detector.table], detector.row);
    question.arguments.contacts = &sink;
    step_.report.visited += active ? active->members().size() : step_.world.host().bodies.size();
    // A list of the active participants pays only where the detector would go through many others. Where pairs are named it need not.
    constexpr std::size_t kFew = 8;
    if (active) question.context.active_bodies = active->flags();
    if (active && !sink.only_persistent() && kFew * active->members().size() < active->flags().size())
        question.context.shortlists = shortlists_of(index, *active);
    const CostScope scope(step_.meter, step_.meter.of_component(detector.component));
    step_.meter.ran(detector.table, Phase::Detect);
    if (const auto done = question.run(*detector.command); !done)
        question.context.emit(detector.row, "detection.failed", Severity::Failure, done.error().reason);
}

/// Asks for what the sink collects. Returns whether that is sorted.
bool ContactBook::ask(const Detector& detector, ContactCollector& sink, std::span<const PersistentPair> persistent, bool only_persistent)
{
    const auto index = static_cast<std::size_t>(&detector - detectors_.data());
    asked_.begin(step_.world.host().bodies.size());
    const bool some = only_persistent && seen_in_[index] == step_.serial;
    if (some)
        for (const PersistentPair& p : persistent) asked_.add(p.a.index), asked_.add(p.b.index);
    query(detector, sink, some ? &asked_ : only_persistent ? nullptr : awake_);
    step_.report.further_pairs += sink.further_pairs();
    return sink.in_order();
}

bool ContactBook::detect(const Detector& detector, std::uint32_t index, std::span<const PersistentPair> persistent, bool only_persistent,
                         std::vector<FoundContact>& out, double margin)
{
    ContactCollector sink(step_.world, out);
    sink.begin_query(index, persistent, only_persistent, margin);
    if (detector.by_force) sink.want_level_rims();
    return ask(detector, sink, persistent, only_persistent);
}

void ContactBook::detect_all()
{
    if (awake_ && !std::exchange(has_detected_all_, true))
    {
        const IndexSet* const awake = std::exchange(awake_, nullptr);
        detect_all();
        awake_ = awake;
    }
    found_.clear(), runs_.clear(), ++found_revision_;
    bool in_order = true;
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        if (detectors_[d].by_rows && detectors_[d].may_persist())
        {
            in_order = detect_with_gaps(d) && in_order;
            continue;
        }
        persistent_.clear();
        double margin = 0;
        for (const PairState& p : cache_.pairs())
            if (p.resting && p.detector == detectors_[d].component)
                persistent_.push_back({p.a, p.b, {}}), margin = std::max(margin, persistence_margin(p));
        const std::size_t first = found_.size();
        in_order = detect(detectors_[d], d, persistent_, false, found_, margin) && in_order;
        // A detection pass has one margin, the largest of all persistent pairs. Gaps count for persistent pairs only, each up to its own
        // margin, so the others are dropped again.
        std::size_t near = 0;
        const auto far = [&](const FoundContact& f)
        {
            if (f.contact.depth > 0) return false;
            const PairState* pair = find_pair(f, near);
            return !pair || !pair->resting || f.contact.depth <= -persistence_margin(*pair);
        };
        found_.erase(std::remove_if(found_.begin() + static_cast<std::ptrdiff_t>(first), found_.end(), far), found_.end());
        list_runs(first);
    }
    if (in_order) return;
    sort_contacts(found_, step_.world);
    runs_.clear(), list_runs(0);
}

/// Adds the pairs in found_ from this place on.
void ContactBook::list_runs(std::size_t from)
{
    for (auto i = static_cast<std::uint32_t>(from), end = i; i < found_.size(); i = end)
    {
        while (end < found_.size() && same_pair(found_[end], found_[i])) ++end;
        const FoundContact& f = found_[i];
        runs_.push_back({i, end, PairKey(step_.world, detectors_[f.detector].component, f.contact.a, f.contact.b)});
    }
}

void ContactBook::detect_known_pairs()
{
    found_.clear(), runs_.clear(), ++found_revision_;
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        persistent_.clear();
        for (const PairState& p : cache_.pairs())
            if (p.detector == detectors_[d].component)
                persistent_.push_back({p.a, p.b, p.resting ? p.normal * -persistence_margin(p) : Vec3{}});
        if (!persistent_.empty()) detect(detectors_[d], d, persistent_, true, found_);
    }
    sort_contacts(found_, step_.world);
    list_runs(0);
}

/// Contacts of a detector of which some pairs at least are persistent as soon as they touch. Includes gaps up to the persistence margin,
/// gaps that may close within the step (speculative contacts), and, for pairs that pressed, gaps that curvature opens. Returns whether they
/// are sorted.
bool ContactBook::detect_with_gaps(std::uint32_t index)
{
    const Detector& detector = detectors_[index];
    const Bodies& bodies = step_.world.host().bodies;
    double margin = 0, fastest = 0;
    // At least one body of each pair is awake, and the smaller one decides.
    const auto each = [&](const auto& job)
    {
        if (awake_)
            for (const std::uint32_t b : awake_->members()) job(b);
        else
            for (std::uint32_t b = 0; b < bodies.size(); ++b) job(b);
    };
    each([&](std::uint32_t b) { fastest = std::max(fastest, length_squared(bodies.velocity[b])); });
    fastest = std::sqrt(fastest);
    const auto widen = [&](std::uint32_t b)
    {
        if (!bodies.dynamic(b) || !std::isfinite(radius_of_body_[b])) return;
        // The other body may be round as well, with any radius.
        const double opens = opening_by_curves(2 * fastest, step_.frame.step, curve_radius_of_body_[b]);
        margin = std::max(margin, kPersistenceShare * radius_of_body_[b] + std::min(opens, kMostShare * radius_of_body_[b]));
    };
    each(widen);
    const double acceleration = detector.speculation_acceleration.value_or(0);
    if (detector.speculates) margin = std::max(margin, speculative_margin(bodies, radius_of_body_, acceleration, step_.frame.step));
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
    const auto counts = [&](const Contact& c)
    {
        if (c.depth > 0 || c.depth > -persistence_margin(c.a, c.b) || c.depth > -margin_of(c)) return true;
        return detector.speculates && may_close(bodies, radius_of_body_, c, acceleration, step_.frame.step);
    };
    SelectingCollector sink(step_.world, detector.component, found_, runs_, counts);
    sink.begin_query(index, {}, false, margin);
    return ask(detector, sink, {}, false);
}

void ContactBook::warm_start(std::span<FoundContact> contacts, bool begins)
{
    std::size_t near = 0;
    for (FoundContact& f : contacts) f.contact.impulse = cache_.contact_of(*find_pair(f, near), f).warm_start(begins);
}

PairState* ContactBook::find_pair(const FoundContact& f)
{
    return cache_.find(detectors_[f.detector].component, f.contact.a, f.contact.b, step_.world);
}

PairState* ContactBook::find_pair(const FoundContact& f, std::size_t& near)
{
    return cache_.find(detectors_[f.detector].component, f.contact.a, f.contact.b, step_.world, near);
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

void ContactBook::touching_pairs_of(std::span<const std::uint32_t> groups, std::vector<FoundContact>& out, double h, bool only_located)
{
    resting_.find(groups, places_);
    bool in_order = out.empty();
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        persistent_.clear();
        double margin = 0;
        for (const std::uint32_t place : places_)
        {
            const PairState& p = std::as_const(cache_).pairs()[place];
            if (p.detector != detectors_[d].component || (only_located && persists(detectors_[d], p.a, p.b))) continue;
            persistent_.push_back({p.a, p.b, {}});
            margin = std::max({margin, persistence_margin(p), gap_margin(p, h)});
        }
        if (!persistent_.empty()) in_order = detect(detectors_[d], d, persistent_, true, out, margin) && in_order;
    }
    drop_far(out, h);
    if (!in_order) sort_contacts(out, step_.world);
    drop_passed_pairs(out);
    std::size_t near = 0;
    for (FoundContact& f : out)
    {
        f.contact.resting = true;
        const KnownContact& known = cache_.contact_of(*find_pair(f, near), f);
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

}  // namespace plab::simulation
