#include "impulse.h"

namespace plab::response
{
namespace
{

void take_back(std::span<ConeContact> cones, Bodies& bodies)
{
    for (ConeContact& c : cones)
    {
        if (c.impulse == Vec3{}) continue;
        c.point->apply(bodies, -c.impulse, (c.point->velocity(bodies) - c.point->K() * c.impulse).z);
        c.impulse = {};
    }
}

/// Starts the sweeps from the impulses of the last step. These may be too large; if the sweeps end early and leave an energy
/// gain, they start again from zero impulses, from where each sweep only removes energy.
ConeResult solve_without_gain(const ImpactSettings& settings, Workspace& work, Bodies& bodies)
{
    const ConeResult warm = solve_cones(work.cones, bodies, settings.tolerance, settings.max_iterations, settings.interruption);
    if (warm.converged || energy_gained(work.cones, work.before, bodies) == 0) return warm;
    take_back(work.cones, bodies);
    ConeResult cold = solve_cones(work.cones, bodies, settings.tolerance, settings.max_iterations, settings.interruption);
    cold.sweeps += warm.sweeps;
    return cold;
}

}  // namespace

void respond_rest(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact)
{
    const auto contacts = impact.contacts;
    work.gather(contacts, bodies);
    work.sort_by_id(contacts, bodies);
    work.cones.clear();
    for (const std::uint32_t i : work.order)
    {
        const Contact& c = contacts[i];
        const ContactPoint& point = work.points[i];
        // A gap may close within the step, but not further.
        const double least = c.turning + (c.depth < 0 && impact.dt > 0 ? c.depth / impact.dt : 0.0);
        const Vec3 guess = point.to_contact(c.impulse);
        if (guess != Vec3{}) point.apply(bodies, guess, point.velocity(bodies).z + (point.K() * guess).z);
        work.cones.push_back({&point, c.friction, least, guess});
    }
    const ConeResult result = solve_without_gain(settings, work, bodies);
    for (std::size_t k = 0; k < work.order.size(); ++k)
        contacts[work.order[k]].impulse = work.cones[k].point->to_world(work.cones[k].impulse);
    impact.visits = static_cast<std::int64_t>(work.cones.size()) * result.sweeps;
    impact.iterations = result.sweeps, impact.residual = result.residual, impact.converged = result.converged;
}

}  // namespace plab::response
