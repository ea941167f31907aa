#include "simulation/step/totals.h"

#include <algorithm>
#include <cmath>

#include "world/command_call.h"

namespace plab::simulation
{

Totals totals_of(world::World& world, const Stepper& stepper, double time, Tick tick)
{
    Totals t;
    t.work = stepper.departed_work() + stepper.requests_work();
    const world::HostTables& host = world.host();
    for (const std::uint32_t i : stepper.components())
    {
        const world::Component& c = world.component(i);
        if (c.facet == Facet::Body && host.bodies.dynamic(c.host_index))
        {
            const std::uint32_t b = c.host_index;
            t.kinetic += host.bodies.kinetic_energy(b);
            const Vec3 p = host.bodies.velocity[b] * host.bodies.mass[b];
            t.momentum += p;
            t.angular_momentum += cross(host.bodies.position[b], p) + host.bodies.angular_momentum[b];
        }
        if (c.facet == Facet::Shaft && host.shafts.dynamic(c.host_index))
        {
            t.kinetic += host.shafts.kinetic_energy(c.host_index);
            t.shaft_momentum += host.shafts.inertia[c.host_index] * host.shafts.speed[c.host_index];
        }
        // A component that was added within a transaction has no account until the stepper is rebuilt, and has done no work.
        if (i < stepper.work().size()) t.work += stepper.work()[i];
    }
    t.stored = stored_energy_of(world, stepper, time, tick);
    return t;
}

Energies energies_of(world::World& world, const Stepper& stepper, double time, Tick tick)
{
    Energies out;
    const world::HostTables& host = world.host();
    for (const std::uint32_t i : stepper.components())
    {
        const world::Component& c = world.component(i);
        if (c.facet == Facet::Body) out.kinetic += host.bodies.kinetic_energy(c.host_index);
        if (c.facet == Facet::Shaft) out.kinetic += host.shafts.kinetic_energy(c.host_index);
    }
    out.stored = stored_energy_of(world, stepper, time, tick);
    return out;
}

double stored_energy_of(world::World& world, const Stepper& stepper, double time, Tick tick)
{
    StoredEnergy stored;
    world::CommandCall call;
    call.context.time = time, call.context.tick = tick;
    PhaseCall& to = call.arguments;
    to.bodies = &world.host().bodies, to.shafts = &world.host().shafts, to.shapes = &world.host().shapes, to.stored = &stored;
    for (const Block& block : stepper.schedule().of(Phase::Potential))
    {
        call.select(*world.tables()[block.table]);
        (void)call.run(*block.command, block.rows);
    }
    return stored.joule;
}

double least_energy(const world::HostTables& host, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> shafts,
                    std::span<const double> radius_of_body, double h)
{
    constexpr double kShare = 0.03;
    double sum = 0;
    for (const std::uint32_t b : bodies)
    {
        if (!host.bodies.dynamic(b)) continue;
        const double radius = b < radius_of_body.size() && radius_of_body[b] > 0 && std::isfinite(radius_of_body[b])
                                  ? radius_of_body[b]
                                  : std::sqrt((host.bodies.inertia_B[b](0, 0) + host.bodies.inertia_B[b](1, 1)) / host.bodies.mass[b]);
        sum += 0.5 * host.bodies.mass[b] * (kShare * radius / h) * (kShare * radius / h);
    }
    for (const std::uint32_t s : shafts)
        if (host.shafts.dynamic(s)) sum += 0.5 * host.shafts.inertia[s] * (kShare / h) * (kShare / h);
    return sum;
}

}  // namespace plab::simulation
