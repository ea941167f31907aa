#include "simulation/systems/stage_scratch.h"

#include <algorithm>

namespace plab::simulation
{

void StageScratch::fit(const world::World& world)
{
    const world::HostTables& host = world.host();
    active_ = 0;
    places_.clear();
    set_bodies_.clear(), set_shafts_.clear();
    for (auto* flags : {&active_bodies, &accounted_bodies}) flags->assign(host.bodies.size(), 0);
    for (auto* flags : {&active_shafts, &accounted_shafts}) flags->assign(host.shafts.size(), 0);
    wrenches.bind(host.bodies, host.shafts);
    wrenches.force.resize(host.bodies.size()), wrenches.torque.resize(host.bodies.size());
    wrenches.shaft_torque.resize(host.shafts.size());
    wrenches.quantity_rate.resize(host.quantities.size());
    for (std::size_t i = 0; i < host.quantities.size(); ++i) wrenches.quantity_rate[i].assign(host.quantities.value[i].size(), 0.0);
    for (auto* column : {&moved_bodies.position, &moved_bodies.velocity, &moved_bodies.angular_velocity})
        column->assign(host.bodies.size(), {});
    moved_shafts.speed.assign(host.shafts.size(), 0.0);
    power.assign(world.components().size(), 0.0);
    own_meter_.accounts().fit(world.components().size(), world.tables().size());
}

void StageScratch::deactivate()
{
    for (const std::uint32_t b : set_bodies_) active_bodies[b] = accounted_bodies[b] = 0;
    for (const std::uint32_t s : set_shafts_) active_shafts[s] = accounted_shafts[s] = 0;
    set_bodies_.clear(), set_shafts_.clear();
}

const StageScratch::Places& StageScratch::places_in(const RefList& all)
{
    const auto known = std::find_if(places_.begin(), places_.end(), [&](const Places& p) { return p.all == &all; });
    if (known != places_.end()) return *known;
    Places& fresh = places_.emplace_back();
    fresh.all = &all;
    fresh.of_body.assign(active_bodies.size(), kNoIndex), fresh.of_shaft.assign(active_shafts.size(), kNoIndex);
    for (std::uint32_t i = 0; i < all.size(); ++i)
        if (all[i].facet == Facet::Body)
            fresh.of_body[all[i].index] = i;
        else if (all[i].facet == Facet::Shaft)
            fresh.of_shaft[all[i].index] = i;
        else
            fresh.others.push_back(i);
    return fresh;
}

/// A system of few objects need not go through a field's list of all bodies of the scene: many such systems share one index of it.
void StageScratch::list_active(const RefList& all, RefList& out)
{
    constexpr std::size_t kLong = 512, kMostIndexed = 8;
    out.clear();
    const bool known = std::any_of(places_.begin(), places_.end(), [&](const Places& p) { return p.all == &all; });
    if (all.size() < kLong || 4 * (set_bodies_.size() + set_shafts_.size()) > all.size() || (!known && places_.size() == kMostIndexed))
    {
        const auto is_active = [&](Ref r)
        {
            if (r.facet == Facet::Body) return active_bodies[r.index] != 0;
            return r.facet != Facet::Shaft || active_shafts[r.index] != 0;
        };
        std::copy_if(all.begin(), all.end(), std::back_inserter(out), is_active);
        return;
    }
    const Places& places = places_in(all);
    found_ = places.others;
    for (const std::uint32_t b : set_bodies_)
        if (places.of_body[b] != kNoIndex) found_.push_back(places.of_body[b]);
    for (const std::uint32_t s : set_shafts_)
        if (places.of_shaft[s] != kNoIndex) found_.push_back(places.of_shaft[s]);
    std::sort(found_.begin(), found_.end());
    for (const std::uint32_t place : found_) out.push_back(all[place]);
}

void StageScratch::activate(std::uint64_t configuration, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> shafts)
{
    deactivate();
    active_ = configuration;
    set_bodies_.assign(bodies.begin(), bodies.end());
    set_shafts_.assign(shafts.begin(), shafts.end());
    for (const std::uint32_t b : set_bodies_) active_bodies[b] = 1;
    for (const std::uint32_t s : set_shafts_) active_shafts[s] = 1;
}

}  // namespace plab::simulation
