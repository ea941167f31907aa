#include <algorithm>

#include "impulse.h"

namespace plab::response
{

void respond_rest(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact)
{
    const auto contacts = impact.contacts;
    work.points.clear(), work.cones.clear(), work.order.clear();
    double speed = 0;
    for (std::uint32_t i = 0; i < contacts.size(); ++i)
    {
        work.points.emplace_back(contacts[i], bodies);
        if (work.points.back().moves()) work.order.push_back(i);
    }
    std::sort(work.order.begin(), work.order.end(), [&](auto i, auto j) { return contacts[i].id < contacts[j].id; });
    for (const std::uint32_t i : work.order)
    {
        const Contact& c = contacts[i];
        const ContactPoint& point = work.points[i];
        // A gap may close within the step, and no further.
        const double least = c.depth < 0 && impact.dt > 0 ? c.depth / impact.dt : 0.0;
        const Vec3 guess = point.to_contact(c.impulse);
        if (guess != Vec3{}) point.apply(bodies, guess, point.velocity(bodies).z + (point.K() * guess).z);
        work.cones.push_back({&point, c.friction, least, guess});
    }
    const ConeResult result = solve_cones(work.cones, bodies, std::max(settings.tolerance, 0x1p-46 * speed), settings.max_iterations);
    for (std::size_t k = 0; k < work.order.size(); ++k)
        contacts[work.order[k]].impulse = work.cones[k].point->to_world(work.cones[k].impulse);
    impact.iterations = result.sweeps, impact.residual = result.residual, impact.converged = result.converged;
}

}  // namespace plab::response
