// Manager/Automatic: which method advances an island, and why.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "advance_island.h"
#include "manager_rows.h"
#include "plab/number_text.h"
#include "plab/row_mobility.h"
#include "soft_step.h"
#include "solve_islands.h"

namespace plab::managers
{

void AutomaticRows::describe(Schema& s)
{
    // What Direct holds still moves by rounding alone, some 1e-13 m/s: it may sleep without a loss of digits. What SoftStep holds sways.
    constexpr double kRestsAfter = 0.5, kRestSpeed = 1e-9;  // s, m/s

    s.param(max_points, "max_points", unit::one,
            "an island of at most so many contact points and rows is solved exactly; up to 16 times as many if rows of joints are twice as "
            "many as contact points, as sweeps would let them stretch")
        .or_else(kSolvedExactly)
        .not_negative()
        .at_most(20000);
    s.param(max_resting, "max_resting", unit::one,
            "an island of at most so many contact points and rows that hardly moves is solved exactly too, if Newton's method soon finds "
            "that it rests")
        .or_else(12000)
        .not_negative()
        .at_most(20000);
    s.param(
         heavy, "heavy", unit::one,
         "ratio of the heaviest to the lightest body above which sweeps would let bodies sink: such an island is solved exactly up to 16 "
         "times as many points")
        .or_else(20)
        .at_least(1);
    s.param(tolerance, "tolerance", unit::metre_per_second,
            "largest remaining violation; with a larger one the step counts as not converged")
        .or_else(0.1)
        .positive();
    s.output(resolved, "resolved", unit::one, "the methods that advanced the islands of the last step");
    s.output(reason, "reason", unit::one, "why the larger of its islands were advanced so");
    s.output(direct_islands, "direct_islands", unit::one, "islands that were solved exactly in the last step");
    s.output(soft_islands, "soft_islands", unit::one, "islands that were advanced by SoftStep in the last step");
    account.describe(s), sleep.describe(s, kRestsAfter, kRestSpeed);
    s.scratch(memory, "memory", "working memory");
    s.scratch(choices, "choices", "working memory");
}

namespace
{

constexpr std::size_t kHeavyPoints = 16, kServoPoints = 4;  // times max_points
/// An island at rest, or nearly so, is solved within these Newton steps. One that tumbles costs no more than they do: sweeps finish.
constexpr Solving kAffordable{1e-12, 12, 20, 1e-12};
/// Where a stiff servo presses, sweeps would let it hammer: as many steps as Manager/Direct, if they are made within about 0.1 s.
constexpr Solving kOfServos{.tolerance = 1e-12, .most_steps = 80, .most_sweeps = 20, .most_products = 1'000'000};
/// Ends of sliding are located for a body that slides alone.
constexpr std::size_t kSlipEnds = 4;
/// Heaps overlap a quarter as much as with SoftStep's own default, and sway less; a row of bodies that moves comes to rest more slowly.
constexpr double kSoftDamping = 3;

/// The ratio of the heaviest to the lightest body of an island.
double mass_ratio(const Island& island, const Bodies& bodies)
{
    double least = HUGE_VAL, most = 0;
    for (const std::uint32_t b : island.bodies) least = std::min(least, bodies.mass[b]), most = std::max(most, bodies.mass[b]);
    return most > 0 ? most / least : 1.0;
}

/// Keeps `resolved` and `reason` of the step. `context.events` is null in trials, which leave nothing behind.
void note_method(const StepContext& context, Row row, AutomaticRows& rows, const AutomaticRows::Choice& chosen)
{
    if (!context.events) return;
    if (rows.account.step[row] != context.tick) rows.direct_islands[row] = rows.soft_islands[row] = 0;
    ++(chosen.direct ? rows.direct_islands : rows.soft_islands)[row];
    const std::string_view used = rows.soft_islands[row] == 0 ? "Direct" : rows.direct_islands[row] == 0 ? "SoftStep" : "Direct, SoftStep";
    if (rows.resolved[row] == used) return;
    rows.resolved[row] = used;
    if (chosen.direct && rows.soft_islands[row] != 0) return;
    rows.reason[row] = std::string(chosen.direct ? "Direct: " : "SoftStep: ") + "an island has " + std::to_string(chosen.points) +
                       " contact points and rows" + (chosen.joints > 0 ? ", " + std::to_string(chosen.joints) + " rows of joints" : "") +
                       ", and masses up to " + rounded_text(chosen.ratio, 2) + " to 1";
}

/// How far a body of the island moves in a step at its present speed, in units of the island's size.
double travel_of(const Island& island, const Bodies& bodies)
{
    double most = 0;
    for (const std::uint32_t b : island.bodies)
        most = std::max(most, length(bodies.velocity[b]) + island.size * length(bodies.angular_velocity[b]));
    return most * island.h / island.size;
}

/// What to spend on the question whether an island stays where it is, in products of blocks. One that does not move has been solved exactly
/// in the last step, which takes few Newton steps again, or has been put there. One that SoftStep holds sways; it may be in equilibrium all
/// the same, which is worth a small try now and then. The state alone tells when, so that a run that is rewound or restored tries in the
/// same steps.
std::size_t worth_of_rest(const Island& island, const Bodies& bodies, Tick tick)
{
    constexpr double kStill = 1e-9, kSlow = 0x1p-8;
    constexpr std::size_t kEvery = 64, kOfStill = 12'000'000, kOfSlow = 400'000;  // about 1 s and 30 ms at most
    if (island.bodies.empty()) return 0;
    const double travel = travel_of(island, bodies);
    if (travel <= kStill) return kOfStill;
    const bool due = (static_cast<std::size_t>(tick) + island.contacts.size() + island.bodies.size()) % kEvery == 0;
    return travel <= kSlow && due ? kOfSlow : 0;
}

/// J M^-1 J^T of a row.
double mobility_of(const ConstraintRow& row, const Island& island, const Bodies& bodies)
{
    double mobility = 0;
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        const std::uint32_t i = b.participant.index;
        if (b.participant.facet == Facet::Body)
            mobility += mobility_of(bodies, b);
        else if (i < island.shaft_mobility.size())
            mobility += b.angular.x * b.angular.x * island.shaft_mobility[i];
    }
    return mobility;
}

/// Whether a contact may press in this step: it touches, it has pressed, or its gap closes at the present velocities. The others of those
/// that bodies might meet (Resolution/Speculative) cost next to nothing.
bool may_press(const Contact& c, const Bodies& bodies, double h)
{
    if (c.depth >= 0 || !(c.impulse == Vec3{})) return true;
    const Vec3 rate = bodies.velocity_at(c.b.index, c.point) - bodies.velocity_at(c.a.index, c.point);
    return dot(rate, c.normal) * h < c.depth;
}

AutomaticRows::Choice choose_method(const StepContext& context, const Island& island, const Bodies& bodies, const AutomaticRows& rows,
                                    Row row)
{
    const auto most = static_cast<std::size_t>(rows.max_points[row]), resting = static_cast<std::size_t>(rows.max_resting[row]);
    const auto is_linear = [](const ConstraintRow& r) { return r.kind == RowKind::Equality || r.kind == RowKind::ForceChange; };
    const auto joints = static_cast<std::size_t>(std::ranges::count_if(island.rows, is_linear));
    const auto presses_on = [&](const Contact& c) { return may_press(c, bodies, island.h); };
    // A heap is far beyond all bounds, whatever of it touches.
    const bool heap = island.contacts.size() > 4 * kHeavyPoints * most;
    const auto contacts = heap ? island.contacts.size() : static_cast<std::size_t>(std::ranges::count_if(island.contacts, presses_on));
    const std::size_t points = contacts + island.rows.size() - joints;
    const double ratio = mass_ratio(island, bodies);
    // Sweeps let joints stretch under load, the more the longer the chain; a tree of joints costs a factorisation linear time. Where
    // contact points prevail, as in a heap of jointed bodies, each of them may change its state in each iteration, which costs far more.
    // Against a contact, a link that a stiff servo presses on something weighs many times what it does alone.
    const auto is_servo = [&](const ConstraintRow& r)
    { return r.kind == RowKind::ForceChange && is_stiff(r, mobility_of(r, island, bodies), island.h); };
    const bool presses = std::ranges::any_of(island.rows, is_servo);
    const bool yields = ratio >= rows.heavy[row] || 2 * points <= joints;
    const bool direct = points + joints <= most || (yields && points <= kHeavyPoints * most) || (presses && points <= kServoPoints * most);
    const bool asks = !direct && points + joints <= resting;
    return {direct, presses, asks ? worth_of_rest(island, bodies, context.tick) : 0, points, joints, ratio};
}

/// Solves an island exactly if that shows within `products` that it rests; otherwise nothing has been done, and the result is false.
bool holds_at_rest(std::size_t products, Island& island, Bodies& bodies, Shafts& shafts, AutomaticRows::Memory& memory)
{
    const Solving how{.tolerance = 1e-12, .most_steps = 30, .most_sweeps = 0, .rounds = 0, .most_products = products};
    StepChoices choices;
    choices.or_nothing = true;
    choices.correction_share = 0.2;  // what SoftStep has let sink is lifted slowly
    Exactly method(memory.direct.newton, how, island);
    const Verdict verdict = advance_island(island, bodies, shafts, method, choices, memory.direct.step);
    if (verdict.put_back) return false;
    report(island, verdict);
    return true;
}

/// Advances an island; `choice` becomes what has been done.
void advance_by_choice(AutomaticRows::Choice& choice, Island& island, Bodies& bodies, Shafts& shafts, AutomaticRows::Memory& memory,
                       Workers* workers)
{
    memory.direct.step.problem.workers = memory.soft.step.problem.workers = workers;
    if (choice.tries > 0 && holds_at_rest(choice.tries, island, bodies, shafts, memory))
    {
        choice.direct = true;
        return;
    }
    if (!choice.direct)
    {
        SoftChoices choices;
        choices.damping_ratio = kSoftDamping;
        choices.hertz = std::max(choices.hertz, 1 / island.h);  // an eighth of the rate of the sub-steps: stiffer contacts rattle
        return report(island, advance_softly(island, bodies, shafts, choices, memory.soft));
    }
    Exactly method(memory.direct.newton, choice.presses ? kOfServos : kAffordable, island);
    StepChoices choices;
    choices.slip_ends_up_to = kSlipEnds;
    report(island, advance_island(island, bodies, shafts, method, choices, memory.direct.step));
}

}  // namespace

void solve_all_automatically(const StepContext& context, Row row, AutomaticRows& rows, Bodies& bodies, Shafts& shafts,
                             std::span<Island> islands)
{
    std::vector<AutomaticRows::Choice>& choices = rows.choices[row];
    choices.clear();
    for (const Island& island : islands) choices.push_back(choose_method(context, island, bodies, rows, row));
    solve_all(
        context, bodies, shafts, islands, rows.memory[row], [&](std::size_t i) { return !choices[i].direct; },
        [&](std::size_t i, Island& island, AutomaticRows::Memory& memory)
        { advance_by_choice(choices[i], island, bodies, shafts, memory, context.workers); });
    for (std::size_t i = 0; i < islands.size(); ++i)
    {
        note_method(context, row, rows, choices[i]);
        islands[i].converged = islands[i].residual <= rows.tolerance[row];
        rows.account.add(context, row, islands[i], rows.tolerance[row]);
    }
}

}  // namespace plab::managers
