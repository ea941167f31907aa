#include "automatic.h"

#include <limits>
#include <string>

#include "plab/number_text.h"

namespace plab::resolution
{
namespace
{

/// In radii per step, of thin bodies in half thicknesses: so far may bodies sink into what they meet. If it is more, two that meet a third
/// one from opposite sides push it to and fro between them, each step out of one and as deep into the other.
constexpr double kFast = 0x1p-5;

std::string_view name_of(ImpactSearch search)
{
    return search == ImpactSearch::Locate ? "LocalRoot" : search == ImpactSearch::Speculate ? "Speculative" : "None";
}

std::string island_text(const ContactLoad& load)
{
    return "the largest islands have " + std::to_string(load.island_bodies) + " bodies and " + std::to_string(load.island_points) +
           " contact points";
}

}  // namespace

void AutomaticRows::describe(Schema& s)
{
    root.describe_search(s);
    s.param(root.max_work, "max_work", unit::one,
            "limit on the work for locating events in a step, as a multiple of the work of the step without it, beyond base_work. The "
            "remaining events are answered at the end of the step (resolution.over_budget)")
        .or_else(4)
        .positive();
    describe_acceleration(s, acceleration);
    s.param(base_work, "base_work", unit::one, "distance queries that a step may always spend on locating impacts")
        .or_else(12000)
        .not_negative();
    s.param(max_bodies, "max_bodies", unit::one, "impacts are located while no island of touching bodies has more bodies than this")
        .or_else(8)
        .positive()
        .at_most(1e6);
    s.param(max_points, "max_points", unit::one, "likewise, contact points of an island").or_else(64).positive().at_most(1e7);
    s.param(max_located, "max_located", unit::one, "likewise, dynamic bodies of the scene").or_else(2000).positive().at_most(1e7);
    s.param(dwell, "dwell", unit::second,
            "after a step with a larger island or more bodies, time without one before impacts are located again")
        .or_else(0.25)
        .not_negative();
    s.state(large_until, "large_until", unit::second, "end of the last step that began with a larger island or more bodies; -inf: none has")
        .or_else(-std::numeric_limits<double>::infinity())
        .may_be_infinite();
    s.output(resolved, "resolved", unit::one, "how the impacts of the last step were found");
    s.output(reason, "reason", unit::one, "why");
}

void choose_search(const StepContext& context, Row row, AutomaticRows& rows, ContactLoad& load)
{
    const bool small = load.island_bodies <= rows.max_bodies[row] && load.island_points <= rows.max_points[row],
               few = load.bodies <= rows.max_located[row];
    if (!small || !few) rows.large_until[row] = context.time + context.dt;
    const bool settled = context.time >= rows.large_until[row] + rows.dwell[row] * (1 - 1e-9);
    if (settled)
        load.search = ImpactSearch::Locate;
    else
        load.search = load.has_manager && load.travel > kFast ? ImpactSearch::Speculate : ImpactSearch::AtEnd;
    if (rows.resolved[row] == name_of(load.search)) return;
    const bool first = rows.resolved[row].empty();
    rows.resolved[row] = name_of(load.search);
    rows.reason[row] = rows.resolved[row] + ": " + (few ? island_text(load) : std::to_string(load.bodies) + " bodies move");
    if (small && few && !settled) rows.reason[row] += ", for less than " + rounded_text(rows.dwell[row], 3) + " s";
    if (load.search != ImpactSearch::Locate)
        rows.reason[row] += load.search == ImpactSearch::Speculate
                                ? ", and a body moves by " + rounded_text(load.travel, 2) + " of its size in a step"
                                : ", and no body moves far in a step";
    if (first && load.search == ImpactSearch::Locate) return;
    context.emit(row, "resolution.chosen", Severity::Info, rows.reason[row],
                 {static_cast<double>(load.island_bodies), static_cast<double>(load.island_points), load.travel});
}

void find_root_automatically(const StepContext& context, Row row, const AutomaticRows& rows, EventBracket& trial)
{
    find_root(context, row, rows.root, trial);
}

}  // namespace plab::resolution
