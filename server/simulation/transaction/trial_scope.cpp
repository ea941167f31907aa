#include "simulation/transaction/trial_scope.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace plab::simulation
{
namespace
{

bool is_object(Facet facet) { return facet == Facet::Body || facet == Facet::Shaft || facet == Facet::Quantities; }

bool names_objects(const Role& role) { return std::any_of(role.facets.begin(), role.facets.end(), is_object); }

}  // namespace

/// For each body, those that it touches: known pairs, in either direction. Built once, so that a scope is closed in a time that is linear
/// in the pairs, however long the chains of touching bodies are.
class TrialScope::TouchingBodies
{
public:
    TouchingBodies(const world::World& world, const ContactCache& contacts)
    {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
        const auto& order = world.in_id_order();
        const auto body_of = [&](std::uint32_t rank) { return world.component(order[rank]).host_index; };
        pairs.reserve(contacts.keys().size() + contacts.force_pairs().size());
        for (const PairKey& key : contacts.keys()) pairs.emplace_back(body_of(key.a), body_of(key.b));
        for (const ForcePair& p : contacts.force_pairs()) pairs.emplace_back(p.a.index, p.b.index);
        begin_.assign(world.host().bodies.size() + 1, 0);
        for (const auto& [a, b] : pairs) ++begin_[a], ++begin_[b];
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        others_.resize(2 * pairs.size());
        for (const auto& [a, b] : pairs) others_[--begin_[a]] = b, others_[--begin_[b]] = a;
    }
    template <class Visit>
    void for_each_at(std::uint32_t body, Visit visit) const
    {
        for (std::uint32_t k = begin_[body]; k < begin_[body + 1]; ++k) visit(others_[k]);
    }

private:
    std::vector<std::uint32_t> begin_, others_;  ///< by body, and one more
};

void TrialScope::fit()
{
    const world::HostTables& host = world_->host();
    bodies_.resize(host.bodies.size(), 0), shafts_.resize(host.shafts.size(), 0), quantities_.resize(host.quantities.size(), 0);
    visited_.resize(world_->components().size(), 0);
}

bool TrialScope::mark(Ref object)
{
    const world::HostTables& host = world_->host();
    std::vector<std::uint8_t>* list = nullptr;
    if (object.facet == Facet::Body && host.bodies.motion[object.index] != Motion::Static) list = &bodies_;
    if (object.facet == Facet::Shaft && host.shafts.motion[object.index] != Motion::Static) list = &shafts_;
    if (object.facet == Facet::Quantities) list = &quantities_;
    if (!list || (*list)[object.index] != 0) return false;
    (*list)[object.index] = 1;
    marked_.push_back(object);
    return true;
}

void TrialScope::add(Ref object)
{
    if (sample_) return;
    fit();
    (void)mark(object);
}

void TrialScope::add_object(Ref object)
{
    if (!mark(object) && object.facet == Facet::Body) fixed_.push_back(object.index);
}

void TrialScope::add(std::uint32_t component)
{
    if (sample_) return;
    fit();
    ++visit_;
    visit(component);
}

void TrialScope::add_new(std::uint32_t component)
{
    fit();
    const world::Component& c = world_->component(component);
    if (c.table == kNoIndex || c.facet == Facet::Shape) return;  // a shape acts only through the bodies that have it
    if (is_object(c.facet))
    {
        (void)mark(c.ref(component));
        everything_ = everything_ || !holds(c.ref(component));
        return;
    }
    (void)mark_participants(component);
    everything_ = everything_ || !acts_on_scope(component);
}

/// Marks the objects that the component names in its roles. Returns false if it has no such role.
bool TrialScope::mark_participants(std::uint32_t component)
{
    bool any = false;
    for (const Role& role : world_->table_of(component).schema().roles())
    {
        if (!names_objects(role)) continue;
        any = true;
        world_->for_each_participant(component, role, [&](Ref r) { (void)mark(r); });
    }
    return any;
}

void TrialScope::visit(std::uint32_t component)
{
    const world::Component& c = world_->component(component);
    if (c.table == kNoIndex || std::exchange(visited_[component], visit_) == visit_) return;
    if (is_object(c.facet)) return add_object(c.ref(component));
    if (mark_participants(component)) return;
    for (const std::uint32_t referrer : world_->referrers(component)) visit(referrer);
}

bool TrialScope::holds(Ref object) const
{
    if (everything_) return true;
    const auto in = [&](const std::vector<std::uint8_t>& list) { return object.index < list.size() && list[object.index] != 0; };
    if (object.facet == Facet::Body) return in(bodies_);
    if (object.facet == Facet::Shaft) return in(shafts_);
    return object.facet == Facet::Quantities && in(quantities_);
}

std::size_t TrialScope::objects() const { return marked_.size(); }

/// Groups that read one another are advanced together, so a cluster is in the scope as a whole or not at all.
void TrialScope::mark_cluster(const Groups& groups, std::uint32_t cluster)
{
    for (const std::uint32_t g : groups.of_cluster(cluster))
    {
        const Group& member = groups.all[g];
        for (const auto* list : {&member.bodies, &member.prescribed_bodies})
            for (const std::uint32_t b : *list) (void)mark({Facet::Body, b});
        for (const auto* list : {&member.shafts, &member.prescribed_shafts})
            for (const std::uint32_t s : *list) (void)mark({Facet::Shaft, s});
        for (const std::uint32_t q : member.quantities) (void)mark({Facet::Quantities, q});
    }
}

/// A prescribed object is not affected by forces, so it does not pass effects on to others.
bool TrialScope::carries_on(Ref object) const { return object.facet == Facet::Body && world_->host().bodies.dynamic(object.index); }

/// A detector that rewinds the whole world at a collision acts on an object in the scope: then everything is in the scope.
bool TrialScope::rewinds_everything(const Stepper& stepper) const
{
    const auto concerns = [&](const Detector& d) { return d.locates && !d.local && acts_on_scope(d.component); };
    return std::any_of(stepper.detectors().begin(), stepper.detectors().end(), concerns);
}

/// Follows objects to what moves with them, reads them or touches them.
class TrialScope::Closure
{
public:
    Closure(TrialScope& scope, const Stepper& stepper) : scope_(scope), stepper_(stepper), whole_(stepper.groups().clusters, 0) {}

    /// Marks the objects that touch a body. With `look` none is marked. Returns whether there is one that is not in the scope.
    bool mark_touching(std::uint32_t body, bool look = false)
    {
        if (!touching_) touching_.emplace(*scope_.world_, stepper_.contacts());
        bool any = false;
        const auto visit = [&](std::uint32_t other)
        {
            const Ref object{Facet::Body, other};
            any = any || (look && scope_.world_->host().bodies.motion[other] != Motion::Static && !scope_.holds(object));
            if (!look) (void)scope_.mark(object);
        };
        touching_->for_each_at(body, visit);
        return any;
    }
    /// From each object that is marked, beginning with this one. Contacts are followed only while fewer than `most` objects are marked;
    /// what is integrated or coupled with an object is always marked. Returns whether nothing was left out.
    bool follow(std::size_t from, std::size_t most)
    {
        const Groups& groups = stepper_.groups();
        bool all = true;
        for (std::size_t k = from; k < scope_.marked_.size(); ++k)
        {
            const Ref object = scope_.marked_[k];
            const std::uint32_t g = groups.of(object);
            // The cluster is in the scope as a whole.
            if (g != kNoIndex && std::exchange(whole_[groups.all[g].cluster], 1) == 0) scope_.mark_cluster(groups, groups.all[g].cluster);
            if (!scope_.carries_on(object)) continue;
            const bool full = scope_.marked_.size() >= most;
            all = !(mark_touching(object.index, full) && full) && all;
        }
        return all;
    }
    /// Nothing is in the scope any more.
    void restart() { std::fill(whole_.begin(), whole_.end(), std::uint8_t{0}); }

private:
    TrialScope& scope_;
    const Stepper& stepper_;
    std::optional<TouchingBodies> touching_;
    std::vector<std::uint8_t> whole_;  ///< by cluster: all of it is in the scope
};

void TrialScope::unmark()
{
    for (const Ref object : marked_)
        (object.facet == Facet::Body ? bodies_ : object.facet == Facet::Shaft ? shafts_ : quantities_)[object.index] = 0;
    marked_.clear();
}

/// Objects are taken from the list at equal distances (of the golden section, so that they are spread evenly wherever this ends), each with
/// its share of the limit. Returns false if so much is coupled with one another that it is no sample.
bool TrialScope::draw_sample(Closure& closure, const std::vector<Ref>& all)
{
    constexpr std::size_t kPieces = 8;     // at least, if there are as many objects
    constexpr std::size_t kMostTimes = 4;  // the limit, by what is coupled
    const std::size_t n = all.size(), share = std::max<std::size_t>(1, most_ / std::min(kPieces, n));
    std::size_t distance = std::max<std::size_t>(1, static_cast<std::size_t>(0.618 * static_cast<double>(n)));
    while (std::gcd(distance, n) != 1) ++distance;
    unmark(), closure.restart();
    holds_neighbours_ = false;
    for (std::size_t i = 0, at = 0; i < n && marked_.size() < most_; ++i, at = (at + distance) % n)
    {
        const std::size_t from = marked_.size();
        if (!mark(all[at])) continue;
        holds_neighbours_ = !closure.follow(from, std::min(from + share, most_)) || holds_neighbours_;
    }
    return marked_.size() <= kMostTimes * most_;
}

void TrialScope::close(const Stepper& stepper)
{
    fit();
    Closure closure(*this, stepper);
    if (sample_)
    {
        holds_neighbours_ = !closure.follow(0, 0) || holds_neighbours_;
        return;
    }
    if (!everything_)
        for (const std::uint32_t body : fixed_) (void)closure.mark_touching(body);
    everything_ = everything_ || rewinds_everything(stepper);
    if (everything_) return;
    const std::vector<Ref> direct = marked_;
    if (most_ != 0 && (direct.size() > most_ || !closure.follow(0, most_)))
    {
        sample_ = draw_sample(closure, direct), concerned_ = direct.size();
        if (sample_) return;
        unmark(), closure.restart();
        for (const Ref object : direct) (void)mark(object);
    }
    (void)closure.follow(0, std::numeric_limits<std::size_t>::max());
    everything_ = rewinds_everything(stepper);
}

bool TrialScope::acts_on_scope(std::uint32_t component) const
{
    for (const Role& role : world_->table_of(component).schema().roles())
    {
        if (!names_objects(role)) continue;
        bool any = false;
        world_->for_each_participant(component, role, [&](Ref r) { any = any || holds(r); });
        if (any) return true;
    }
    return false;
}

void TrialScope::choose_with_parts(std::uint32_t component)
{
    if (std::exchange(selection_.flags[component], 1) != 0) return;
    selection_.components.push_back(component);
    for (const Role& role : world_->table_of(component).schema().roles())
    {
        if (names_objects(role)) continue;
        world_->for_each_participant(component, role,
                                     [&](Ref r)
                                     {
                                         if (r.facet == Facet::Component && r.valid()) choose_with_parts(r.index);
                                     });
    }
}

void TrialScope::choose_components()
{
    fit();
    if (everything_)
        for (const auto& [facet, size] : {std::pair{Facet::Body, bodies_.size()}, std::pair{Facet::Shaft, shafts_.size()},
                                          std::pair{Facet::Quantities, quantities_.size()}})
            for (std::uint32_t i = 0; i < size; ++i) (void)mark({facet, i});
    selection_.flags.assign(world_->components().size(), everything_ ? 1 : 0);
    selection_.components.clear();
    if (everything_)
        selection_.components = world_->in_id_order();
    else
        choose_on_scope();
    list_rows(), list_others();
}

/// The objects in the scope are listed already, and of the others only interactions have to be looked at.
void TrialScope::choose_on_scope()
{
    for (const Ref object : marked_)
        if (const std::uint32_t i = world_->host().component_of(object); i != kNoIndex) choose_with_parts(i);
    for (const auto& table : world_->tables())
    {
        if (table->type().info.facet != Facet::Component) continue;
        for (const std::uint32_t i : table->component_of_row())
            if (i != kNoIndex && acts_on_scope(i)) choose_with_parts(i);
    }
    std::sort(selection_.components.begin(), selection_.components.end(),
              [&](std::uint32_t a, std::uint32_t b) { return world_->rank(a) < world_->rank(b); });
}

void TrialScope::list_rows()
{
    for (auto* rows : {&body_rows_, &shaft_rows_, &quantities_rows_}) rows->clear();
    for (const Ref r : marked_)
        (r.facet == Facet::Body ? body_rows_ : r.facet == Facet::Shaft ? shaft_rows_ : quantities_rows_).push_back(r.index);
    for (auto* rows : {&body_rows_, &shaft_rows_, &quantities_rows_}) std::sort(rows->begin(), rows->end());
}

void TrialScope::list_others()
{
    const world::HostTables& host = world_->host();
    std::vector<std::uint8_t> body(host.bodies.size(), 0), shaft(host.shafts.size(), 0);
    const auto see = [&](Ref r)
    {
        if (r.facet == Facet::Body) body[r.index] = 1;
        if (r.facet == Facet::Shaft) shaft[r.index] = 1;
    };
    for (const std::uint32_t i : selection_.components)
    {
        if (everything_) break;
        const world::Component& c = world_->component(i);
        if (c.table == kNoIndex) continue;
        const world::Table& table = world_->table_of(i);
        if (table.type().takes_part(Phase::Detect)) std::fill(body.begin(), body.end(), std::uint8_t{1});
        for (const Role& role : table.schema().roles())
            if (names_objects(role)) world_->for_each_participant(i, role, see);
    }
    other_body_rows_.clear(), other_shaft_rows_.clear();
    for (std::uint32_t b = 0; b < body.size(); ++b)
        if (body[b] != 0 && !holds({Facet::Body, b})) other_body_rows_.push_back(b);
    for (std::uint32_t s = 0; s < shaft.size(); ++s)
        if (shaft[s] != 0 && !holds({Facet::Shaft, s})) other_shaft_rows_.push_back(s);
}

}  // namespace plab::simulation
