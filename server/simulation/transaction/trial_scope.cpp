#include "simulation/transaction/trial_scope.h"

#include <algorithm>
#include <utility>

namespace plab::simulation
{
namespace
{

bool is_object(Facet facet) { return facet == Facet::Body || facet == Facet::Shaft || facet == Facet::Quantities; }

bool names_objects(const Role& role) { return std::any_of(role.facets.begin(), role.facets.end(), is_object); }

}  // namespace

void TrialScope::fit()
{
    const world::HostTables& host = world_->host();
    bodies_.resize(host.bodies.size(), 0), shafts_.resize(host.shafts.size(), 0), quantities_.resize(host.quantities.size(), 0);
    fixed_.resize(host.bodies.size(), 0);
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
    return true;
}

void TrialScope::add(Ref object)
{
    fit();
    (void)mark(object);
}

void TrialScope::add_object(Ref object)
{
    if (!mark(object) && object.facet == Facet::Body) fixed_[object.index] = 1;
}

void TrialScope::add(std::uint32_t component)
{
    fit();
    std::fill(visited_.begin(), visited_.end(), std::uint8_t{0});
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
        for (const Ref r : world_->participants(component, role)) (void)mark(r);
    }
    return any;
}

void TrialScope::visit(std::uint32_t component)
{
    const world::Component& c = world_->component(component);
    if (c.table == kNoIndex || std::exchange(visited_[component], 1) != 0) return;
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

std::size_t TrialScope::objects() const
{
    std::size_t n = 0;
    for (const auto* list : {&bodies_, &shafts_, &quantities_}) n += static_cast<std::size_t>(std::count(list->begin(), list->end(), 1));
    return n;
}

/// Groups that read one another are advanced together, so a cluster is in the scope as a whole or not at all.
bool TrialScope::close_over_clusters(const Groups& groups)
{
    std::vector<std::uint8_t> in(groups.clusters, 0);
    const auto for_each = [&](auto visit)
    {
        for (const Group& g : groups.all)
        {
            for (const auto* list : {&g.bodies, &g.prescribed_bodies})
                for (const std::uint32_t b : *list) visit(g, Ref{Facet::Body, b});
            for (const auto* list : {&g.shafts, &g.prescribed_shafts})
                for (const std::uint32_t s : *list) visit(g, Ref{Facet::Shaft, s});
            for (const std::uint32_t q : g.quantities) visit(g, Ref{Facet::Quantities, q});
        }
    };
    for_each([&](const Group& g, Ref r) { in[g.cluster] = in[g.cluster] != 0 || holds(r) ? 1 : 0; });
    bool grown = false;
    for_each([&](const Group& g, Ref r) { grown = (in[g.cluster] != 0 && mark(r)) || grown; });
    return grown;
}

/// A prescribed object is not affected by forces, so it does not pass effects on to others.
bool TrialScope::carries_on(Ref object) const { return object.facet == Facet::Body && world_->host().bodies.dynamic(object.index); }

template <class Pairs>
bool TrialScope::close_over_pairs(const Pairs& pairs)
{
    bool grown = false;
    for (const auto& p : pairs)
        for (const auto& [from, to] : {std::pair{p.a, p.b}, std::pair{p.b, p.a}})
            if (fixed_[from.index] != 0 || (holds(from) && carries_on(from))) grown = mark(to) || grown;
    return grown;
}

/// A detector that rewinds the whole world at a collision acts on an object in the scope: then everything is in the scope.
bool TrialScope::rewinds_everything(const Stepper& stepper) const
{
    const auto concerns = [&](const Detector& d) { return d.locates && !d.local && acts_on_scope(d.component); };
    return std::any_of(stepper.detectors().begin(), stepper.detectors().end(), concerns);
}

void TrialScope::close(const Stepper& stepper)
{
    fit();
    for (bool grown = !everything_; grown;)
    {
        grown = close_over_clusters(stepper.groups());
        grown = close_over_pairs(stepper.contacts().pairs()) || grown;
        grown = close_over_pairs(stepper.contacts().force_pairs()) || grown;
    }
    everything_ = everything_ || rewinds_everything(stepper);
}

bool TrialScope::acts_on_scope(std::uint32_t component) const
{
    for (const Role& role : world_->table_of(component).schema().roles())
    {
        if (!names_objects(role)) continue;
        for (const Ref r : world_->participants(component, role))
            if (holds(r)) return true;
    }
    return false;
}

void TrialScope::choose_with_parts(std::uint32_t component)
{
    if (std::exchange(components_[component], 1) != 0) return;
    for (const Role& role : world_->table_of(component).schema().roles())
    {
        if (names_objects(role)) continue;
        for (const Ref r : world_->participants(component, role))
            if (r.facet == Facet::Component && r.valid()) choose_with_parts(r.index);
    }
}

void TrialScope::choose_components()
{
    fit();
    components_.assign(world_->components().size(), everything_ ? 1 : 0);
    if (everything_) return;
    for (const std::uint32_t i : world_->in_id_order())
    {
        const world::Component& c = world_->component(i);
        if (c.table == kNoIndex) continue;
        if (is_object(c.facet) ? holds(c.ref(i)) : acts_on_scope(i)) choose_with_parts(i);
    }
}

}  // namespace plab::simulation
