#include "simulation/transaction/trial_scope.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace plab::simulation
{
namespace
{

bool is_object(Facet facet) { return facet == Facet::Body || facet == Facet::Shaft || facet == Facet::Quantities; }

bool names_objects(const Role& role) { return std::any_of(role.facets.begin(), role.facets.end(), is_object); }

/// For each body, those that it touches: known pairs, in either direction. Built once, so that a scope is closed in a time that is linear
/// in the pairs, however long the chains of touching bodies are.
class TouchingBodies
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

}  // namespace

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
    fit();
    (void)mark(object);
}

void TrialScope::add_object(Ref object)
{
    if (!mark(object) && object.facet == Facet::Body) fixed_.push_back(object.index);
}

void TrialScope::add(std::uint32_t component)
{
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

/// From each object that is found, on to what moves with it, reads it or touches it.
void TrialScope::close(const Stepper& stepper)
{
    fit();
    std::optional<TouchingBodies> touching;
    const auto mark_touching = [&](std::uint32_t body)
    {
        if (!touching) touching.emplace(*world_, stepper.contacts());
        touching->for_each_at(body, [&](std::uint32_t other) { (void)mark({Facet::Body, other}); });
    };
    const Groups& groups = stepper.groups();
    std::vector<std::uint8_t> whole(groups.clusters, 0);  // all of the cluster is in the scope
    if (!everything_)
        for (const std::uint32_t body : fixed_) mark_touching(body);
    for (std::size_t k = 0; !everything_ && k < marked_.size(); ++k)
    {
        const Ref object = marked_[k];
        const std::uint32_t g = groups.of(object);
        if (g != kNoIndex && std::exchange(whole[groups.all[g].cluster], 1) == 0) mark_cluster(groups, groups.all[g].cluster);
        if (carries_on(object)) mark_touching(object.index);
    }
    everything_ = everything_ || rewinds_everything(stepper);
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
