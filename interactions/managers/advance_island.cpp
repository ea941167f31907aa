#include "advance_island.h"

#include <algorithm>

#include "slip_end.h"

namespace plab::managers
{
namespace
{

/// N s on b, W, at each contact: all impulses so far, whose directions may turn within the step.
void add_impacts(const StepMemory& memory, Island& island)
{
    if (island.further_impulses.empty()) return;
    for (std::size_t i = 0; i < memory.impacts.size(); ++i) island.further_impulses[i] += memory.impacts[i];
}

/// What a stop has done in an impact is a part of what it did in the step.
void add_impacts_of_stops(const Problem& problem, Island& island, std::span<const double> impacts)
{
    for (std::size_t i = 0; i < impacts.size(); ++i)
        if (problem.row_of(problem.lines[i]).kind == RowKind::OneSided) island.rows[i].impulse += impacts[i];
}

/// Between two ends of sliding, slip falls linearly (slip_end.h): not under stiff servos, whose forces change within the step.
bool accelerates_evenly(const Problem& problem, const Island& island)
{
    return std::ranges::none_of(problem.lines, [&](const Line& line) { return is_stiff(problem.row_of(line), line.mobility, island.h); });
}

/// Whether a stop is met in this step, with more than a small part of the speeds of its bodies: these end then, and with them what the
/// levers would have turned.
bool meets_stop(const Problem& problem, const Island& island)
{
    constexpr double kPart = 0x1p-7, kRounding = 0x1p-34;
    const auto meets = [&](const Line& line)
    {
        const ConstraintRow& row = problem.row_of(line);
        if (line.count == 0 || row.kind != RowKind::OneSided) return false;
        const double closing = row.rate - problem.rate(line), still = kRounding * (turns_only(row) ? 1 : island.size) / island.h;
        double speeds = 0;
        for (std::uint32_t k = 0; k < line.count; ++k)
        {
            const Mover& m = problem.movers[line.mover[k]];
            speeds += length(line.linear[k]) * length(m.v) + length(line.angular[k]) * length(m.w);
        }
        return closing * island.h > row.error && closing > std::max(still, kPart * speeds);
    };
    return std::ranges::any_of(problem.lines, meets);
}

Verdict put_back(const StepMemory& memory, Bodies& bodies, Shafts& shafts)
{
    take_back_speeds(memory, bodies, shafts);
    return {.converged = false, .put_back = true};
}

}  // namespace

Verdict advance_island(Island& island, Bodies& bodies, Shafts& shafts, Method& method, const StepChoices& choices, StepMemory& memory)
{
    Problem& problem = memory.problem;
    problem.load(island, bodies, shafts);
    if (choices.or_nothing) keep_speeds(bodies, shafts, memory);
    auto& guess = memory.impulses;
    guess.clear(), memory.line_impulses.clear();
    for (const Point& p : problem.points) guess.push_back(p.impulse);
    for (const Line& line : problem.lines) memory.line_impulses.push_back(line.impulse);
    Verdict out = answer_impacts(island, bodies, shafts, method, memory);
    if (choices.or_nothing && !memory.impacts.empty()) return put_back(memory, bodies, shafts);
    add_impacts(memory, island);
    memory.velocities.clear();
    for (const Point& p : problem.points) memory.velocities.push_back(problem.relative_velocity(p));
    for (std::size_t i = 0; i < guess.size(); ++i) problem.points[i].impulse = guess[i];
    for (std::size_t i = 0; i < problem.lines.size(); ++i) problem.lines[i].impulse = memory.line_impulses[i];

    const Moving moving = how_to_move(problem, island.h);
    const bool is_smooth = memory.line_impacts.empty() && !meets_stop(problem, island);
    if (moving == Moving::ByMean && (!problem.has_rows() || (is_smooth && island.motion->put_rows_midway(island.h))))
    {
        problem.put_pivots_midway(bodies, island.h);
        problem.put_lines_midway(island.h);
    }
    const bool locates_slip_ends = !choices.or_nothing && !problem.points.empty() && problem.points.size() <= choices.slip_ends_up_to &&
                                   accelerates_evenly(problem, island);
    if (locates_slip_ends)
        out.join(SlipEnds(island, bodies, shafts, method, choices.slop, memory).advance());
    else
    {
        kick(problem, island, bodies, shafts, island.h);
        problem.read_speeds(bodies, shafts);
        set_targets(problem, island, island.h, choices.slop, moving, memory.passing);
        problem.apply_impulses();
        const Verdict found = method.find_impulses(problem);
        if (choices.or_nothing && !found.converged) return put_back(memory, bodies, shafts);
        out.join(found);
        problem.write_speeds(bodies, shafts);
        move(problem, island, found, island.h, moving);
        store_impulses(problem, island);
        add_impulses(problem, island);
    }
    for (std::size_t i = 0; i < memory.impacts.size(); ++i)
        if (island.contacts[i].approach > 0) island.contacts[i].impulse += memory.impacts[i];
    add_impacts_of_stops(problem, island, memory.line_impacts);
    for (std::size_t i = 0; i < island.further_impulses.size(); ++i) island.further_impulses[i] -= island.contacts[i].impulse;
    const Verdict moved = correct_positions(island, bodies, shafts, method, choices, memory);
    out.iterations += moved.iterations;
    out.fell_back = out.fell_back || moved.fell_back;
    return out;
}

}  // namespace plab::managers
