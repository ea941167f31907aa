#include "impulse.h"

#include <algorithm>
#include <cmath>

namespace plab::response
{

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
    for (std::size_t i = 0; i < impact.contacts.size(); ++i)
    {
        const Vec3 u = work.points[i].velocity(bodies);
        impact.contacts[i].slip = std::hypot(u.x, u.y);
    }
    add_to_outputs(rows, row, context.tick, impact);
}

}  // namespace plab::response
