#include "automatic.h"

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

/// What is chosen for the bodies apart and for the crowded ones.
std::string_view name_of(const ContactLoad& load)
{
    if (load.crowded == 0 || load.search == load.crowded_search) return name_of(load.search);
    if (load.crowded == load.bodies) return name_of(load.crowded_search);
    return load.crowded_search == ImpactSearch::Speculate ? "LocalRoot and Speculative" : "LocalRoot and None";
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
    s.param(max_bodies, "max_bodies", unit::one,
            "impacts of bodies are located while their island of touching bodies has no more than this")
        .or_else(8)
        .positive()
        .at_most(1e6);
    s.param(max_points, "max_points", unit::one, "likewise, contact points of an island").or_else(64).positive().at_most(1e7);
    s.param(max_located, "max_located", unit::one, "no impacts are located in scenes with more dynamic bodies")
        .or_else(2000)
        .positive()
        .at_most(1e7);
    s.param(dwell, "dwell", unit::second,
            "after a step in a larger island, time that a body spends in smaller ones before its impacts are located again")
        .or_else(0.25)
        .not_negative();
    s.output(resolved, "resolved", unit::one, "how the impacts of the last step were found");
    s.output(reason, "reason", unit::one, "why");
}

void choose_search(const StepContext& context, Row row, AutomaticRows& rows, ContactLoad& load)
{
    const bool few = load.bodies <= rows.max_located[row];
    const ImpactSearch at_end = load.has_manager && load.travel > kFast ? ImpactSearch::Speculate : ImpactSearch::AtEnd;
    load.crowded_search = at_end;
    load.search = few && (load.has_manager || load.crowded == 0) ? ImpactSearch::Locate : at_end;
    const std::string_view resolved = name_of(load);
    if (rows.resolved[row] == resolved) return;
    const bool first = rows.resolved[row].empty(), located = load.search == ImpactSearch::Locate && load.crowded == 0;
    rows.resolved[row] = resolved;
    std::string& reason = rows.reason[row] =
        rows.resolved[row] + ": " + (few ? island_text(load) : std::to_string(load.bodies) + " bodies move");
    if (few && load.crowded > 0)
        reason += ", " + std::to_string(load.crowded) + " of " + std::to_string(load.bodies) +
                  " bodies are crowded (in a large island, asleep, or too dear to locate; for " + rounded_text(rows.dwell[row], 3) + " s)";
    if (!located)
        reason += at_end == ImpactSearch::Speculate ? ", and a body moves by " + rounded_text(load.travel, 2) + " of its size in a step"
                                                    : ", and no body moves far in a step";
    if (first && located) return;
    context.emit(row, "resolution.chosen", Severity::Info, reason,
                 {static_cast<double>(load.island_bodies), static_cast<double>(load.island_points), load.travel});
}

void find_root_automatically(const StepContext& context, Row row, const AutomaticRows& rows, EventBracket& trial)
{
    find_root(context, row, rows.root, trial);
}

}  // namespace plab::resolution
