#include "impulse.h"

#include <algorithm>
#include <cmath>

namespace plab::response
{

namespace
{

void take_back(Workspace& work)
{
    for (ConeContact& c : work.cones)
    {
        if (c.impulse == Vec3{}) continue;
        work.velocities.apply(c.contact, -c.impulse, (work.velocities.at(c.contact) - work.velocities.K(c.contact) * c.impulse).z);
        c.impulse = {};
    }
}

/// Starts the sweeps from the impulses of the last step. These may be too large; if the sweeps end early and leave an energy
/// gain, they start again from zero impulses, from where each sweep only removes energy.
ConeResult solve_without_gain(const ImpactSettings& settings, Workspace& work)
{
    const auto solve = [&]
    { return solve_cones(work.cones, work.velocities, settings.tolerance, settings.max_iterations, settings.interruption); };
    const ConeResult warm = solve();
    if (warm.converged || energy_gained(work.cones, work.before, work.velocities) == 0) return warm;
    take_back(work);
    ConeResult cold = solve();
    cold.sweeps += warm.sweeps;
    return cold;
}

}  // namespace

void respond_rest(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact)
{
    const auto contacts = impact.contacts;
    work.gather(impact, bodies);
    work.sort_by_id(contacts);
    ContactVelocities& velocities = work.velocities;
    work.cones.clear();
    for (const std::uint32_t i : work.order)
    {
        const Contact& c = contacts[i];
        // A gap may close within the step, but not further.
        const double least = c.turning + (c.depth < 0 && impact.dt > 0 ? c.depth / impact.dt : 0.0);
        const Vec3 guess = velocities.to_contact(i, c.impulse);
        if (guess != Vec3{}) velocities.apply(i, guess, velocities.at(i).z + (velocities.K(i) * guess).z);
        work.cones.push_back({i, c.friction, least, guess});
    }
    const ConeResult result = solve_without_gain(settings, work);
    for (const ConeContact& c : work.cones) contacts[c.contact].impulse = velocities.to_world(c.contact, c.impulse);
    impact.visits = static_cast<std::int64_t>(work.cones.size()) * result.sweeps;
    impact.iterations = result.sweeps, impact.residual = result.residual, impact.converged = result.converged;
}

void ImpulseRows::describe(Schema& s, std::int64_t most_iterations)
{
    describe_impact_law(s, friction, restitution);
    s.param(rest_height, "rest_height", unit::metre,
            "a bounce that would rise less than this is suppressed: the contact becomes a resting one")
        .or_else(1e-14)
        .not_negative();
    s.param(rest_speed, "rest_speed", unit::metre_per_second,
            "where no force presses the bodies together, a rebound up to this speed is suppressed")
        .or_else(1e-9)
        .not_negative();
    s.param(tolerance, "tolerance", unit::metre_per_second, "closing speed that may remain").or_else(1e-12).positive();
    s.param(max_iterations, "max_iterations", unit::one, "sweeps over the contacts").or_else(most_iterations).positive().at_most(1e6);
    s.output(residual, "residual", unit::metre_per_second, "largest closing speed that remained in this step").reported_as_error();
    s.output(iterations, "iterations", unit::one, "sweeps and single impacts in this step");
    s.output(step, "step", unit::one, "the step that these outputs refer to; -1: none yet").or_else(-1);
    s.scratch(workspace, "workspace", "working memory");
}

void respond(const StepContext& context, Row row, ImpulseRows& rows, Bodies& bodies, Impact& impact)
{
    Workspace& work = rows.workspace[row];
    const ImpactSettings settings{{rows.rest_height[row], rows.rest_speed[row]},
                                  rows.tolerance[row],
                                  static_cast<int>(std::min<std::int64_t>(rows.max_iterations[row], 1'000'000)),
                                  context.interruption};
    if (impact.mode == ImpactMode::Impact)
        respond_impact(settings, work, bodies, impact);
    else
        respond_rest(settings, work, bodies, impact);
    for (std::uint32_t i = 0; i < impact.contacts.size(); ++i)
    {
        const Vec3 u = work.velocities.at(i);
        impact.contacts[i].slip = std::hypot(u.x, u.y);
    }
    add_to_outputs(rows, row, context.tick, impact);
}

void AutomaticRows::describe(Schema& s)
{
    s.role(manager, "manager", {Facet::Component}, "advances the islands of these contacts")
        .family("Manager/")
        .default_type("Manager/Automatic");
    // Where impacts cascade through a crowd, what remains after these sweeps is answered at once; few bodies need fewer.
    impulse.describe(s, 300);
    describe_rolling_resistance(s, rolling_friction, spinning_friction);
}

void respond_automatically(const StepContext& context, Row row, AutomaticRows& rows, Bodies& bodies, Impact& impact)
{
    respond(context, row, rows.impulse, bodies, impact);
}

}  // namespace plab::response
