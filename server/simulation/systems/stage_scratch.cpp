#include "simulation/systems/stage_scratch.h"

namespace plab::simulation
{

void StageScratch::fit(const world::World& world)
{
    const world::HostTables& host = world.host();
    owner_ = nullptr;
    set_bodies_.clear(), set_shafts_.clear();
    for (auto* flags : {&active_bodies, &accounted_bodies}) flags->assign(host.bodies.size(), 0);
    for (auto* flags : {&active_shafts, &accounted_shafts}) flags->assign(host.shafts.size(), 0);
    wrenches.bind(host.bodies, host.shafts);
    wrenches.force.resize(host.bodies.size()), wrenches.torque.resize(host.bodies.size());
    wrenches.shaft_torque.resize(host.shafts.size());
    wrenches.quantity_rate.resize(host.quantities.size());
    for (std::size_t i = 0; i < host.quantities.size(); ++i) wrenches.quantity_rate[i].assign(host.quantities.value[i].size(), 0.0);
    power.assign(world.components().size(), 0.0);
    own_meter_.accounts().fit(world.components().size(), world.tables().size());
}

void StageScratch::deactivate()
{
    for (const std::uint32_t b : set_bodies_) active_bodies[b] = accounted_bodies[b] = 0;
    for (const std::uint32_t s : set_shafts_) active_shafts[s] = accounted_shafts[s] = 0;
    set_bodies_.clear(), set_shafts_.clear();
}

void StageScratch::activate(const void* owner, std::uint64_t configuration, std::span<const std::uint32_t> bodies,
                            std::span<const std::uint32_t> shafts)
{
    deactivate();
    owner_ = owner, configuration_ = configuration;
    set_bodies_.assign(bodies.begin(), bodies.end());
    set_shafts_.assign(shafts.begin(), shafts.end());
    for (const std::uint32_t b : set_bodies_) active_bodies[b] = 1;
    for (const std::uint32_t s : set_shafts_) active_shafts[s] = 1;
}

}  // namespace plab::simulation
