#include "rows.h"

#include <algorithm>
#include <cmath>

namespace plab::response
{
namespace
{

constexpr double kRowTolerance = 0x1p-46;  // of the speeds
constexpr int kMostSweeps = 20000, kLeastSweeps = 20;
/// Upper bound on the number of contacts visited in one impact; a closing speed that then remains is reported as the residual.
constexpr std::int64_t kMostVisits = 1'000'000;

/// So many contacts at once take that many sweeps at most. Where joints hold bodies, each visit changes the velocities of all contacts.
int most_sweeps(const Workspace& work)
{
    const auto hit = static_cast<std::int64_t>(std::max<std::size_t>(1, work.order.size()));
    const std::int64_t cost = work.velocities.are_joined() ? hit * hit : hit;
    return static_cast<int>(std::clamp<std::int64_t>(kMostVisits / cost, kLeastSweeps, kMostSweeps));
}

/// Answers all contacts simultaneously, with the fraction `share` of the restitution. Returns whether energy is gained beyond rounding;
/// `visits` grows by the number of contacts visited.
bool try_impact(Workspace& work, std::span<const Contact> contacts, const BounceLimit& bounce, double share, double tolerance,
                ConeResult& result, std::int64_t& visits)
{
    work.cones.clear();
    for (std::size_t k = 0; k < work.order.size(); ++k)
    {
        const Contact& c = contacts[work.order[k]];
        const double closing = -work.before[k].z, rebound = share * c.restitution * closing;
        const double least = closing > 0 && !rests(c, rebound, bounce) ? rebound : 0.0;
        work.cones.push_back({work.order[k], c.friction, least, {}});
    }
    result = solve_cones(work.cones, work.velocities, tolerance, most_sweeps(work));
    visits += static_cast<std::int64_t>(work.cones.size()) * result.sweeps;
    return energy_gained(work.cones, work.before, work.velocities) > 0;
}

}  // namespace

void RowsRows::describe(Schema& s)
{
    s.role(manager, "manager", {Facet::Component}, "advances the islands of these contacts")
        .family("Manager/")
        .default_type("Manager/Direct");
    describe_impact_law(s, friction, restitution);
    describe_rolling_resistance(s, rolling_friction, spinning_friction);
    s.param(rest_height, "rest_height", unit::metre, "where impacts are located: a bounce that would rise less than this is suppressed")
        .or_else(1e-14)
        .not_negative();
    s.param(rest_speed, "rest_speed", unit::metre_per_second,
            "likewise: where no force presses the bodies together, a rebound up to this speed is suppressed")
        .or_else(1e-9)
        .not_negative();
    s.output(residual, "residual", unit::metre_per_second, "largest closing speed that remained after the impacts of this step")
        .reported_as_error();
    s.output(iterations, "iterations", unit::one, "sweeps over impacts in this step");
    s.output(step, "step", unit::one, "the step that these outputs refer to; -1: none yet").or_else(-1);
    s.scratch(workspace, "workspace", "working memory");
}

void respond_rows(const StepContext& context, Row row, RowsRows& rows, Bodies& bodies, Impact& impact)
{
    constexpr int kTrials = 6;
    Workspace& work = rows.workspace[row];
    const BounceLimit bounce{rows.rest_height[row], rows.rest_speed[row]};
    const auto contacts = impact.contacts;
    for (Contact& c : contacts) c.impulse = {};
    work.gather(impact, bodies);
    work.sort_by_id(contacts);
    double speed = 0;
    for (const Vec3& u : work.before) speed = std::max(speed, length(u));
    const double tolerance = kRowTolerance * speed;
    // With friction, Newton's restitution may return more energy than there was; then less is returned, finally none, and at last friction
    // acts less.
    ConeResult result;
    double share = 1;
    impact.iterations = 0, impact.visits = 0;
    work.velocities.keep(work.order);
    bool gains = try_impact(work, contacts, bounce, share, tolerance, result, impact.visits);
    for (int trial = 1; gains && share > 0; ++trial)
    {
        work.velocities.put_back();
        impact.iterations += result.sweeps;
        share = trial < kTrials && impact.visits < kMostVisits ? 0.5 * share : 0.0;
        gains = try_impact(work, contacts, bounce, share, tolerance, result, impact.visits);
    }
    if (gains)
    {
        impact.iterations += result.sweeps;
        result = reduce_friction(work.cones, work.before, work.velocities, tolerance, most_sweeps(work));
        impact.visits += static_cast<std::int64_t>(work.cones.size()) * result.sweeps;
    }
    for (std::size_t k = 0; k < work.order.size(); ++k)
    {
        Contact& c = contacts[work.order[k]];
        c.impulse = work.velocities.to_world(work.order[k], work.cones[k].impulse);
        const Vec3 u = work.velocities.at(work.order[k]);
        c.slip = std::hypot(u.x, u.y);
        c.resting = rests(c, std::max(0.0, u.z), bounce);
    }
    impact.iterations += result.sweeps, impact.residual = std::max(0.0, result.residual), impact.converged = result.converged;
    add_to_outputs(rows, row, context.tick, impact);
}

}  // namespace plab::response
