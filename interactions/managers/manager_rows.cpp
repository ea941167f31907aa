#include "manager_rows.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "advance_island.h"
#include "plab/number_text.h"

namespace plab::managers
{
namespace
{

/// With this many iterations, a step of some hundred contacts still ends within minutes.
constexpr double kMostIterations = 1e6;

constexpr Unit kHertz{"1/s", {{0, 0, -1, 0}}};

/// The fraction of points that are closing but have no initial impulse: they need more sweeps than others.
double unknown_share(const Problem& problem)
{
    const auto is_new = [&](const Point& p)
    { return p.K(2, 2) > 0 && p.impulse == Vec3{} && p.least > kFar && problem.relative_velocity(p).z < p.least; };
    const auto count = std::count_if(problem.points.begin(), problem.points.end(), is_new);
    return problem.points.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(problem.points.size());
}

/// Finds impulses by Gauss-Seidel sweeps.
class Sweeps final : public Method
{
public:
    Sweeps(int iterations, int position_iterations, double tolerance, double relaxation)
        : iterations_(iterations), position_iterations_(position_iterations), tolerance_(tolerance), relaxation_(relaxation)
    {
    }
    Verdict find_impulses(Problem& problem) override
    {
        const Swept done =
            sweep_without_gain(problem, {static_cast<int>(iterations_ * (1 + 9 * unknown_share(problem))), 0.1 * tolerance_, relaxation_});
        problem.apply_impulses();
        const double residual = violation(problem);
        return {done.sweeps, residual, residual <= tolerance_, false};
    }
    Verdict find_displacements(Problem& problem, double tolerance) override
    {
        const Swept done = sweep(problem, {position_iterations_, tolerance, relaxation_});
        problem.apply_impulses();
        return {done.sweeps, 0, true, false};
    }

private:
    int iterations_, position_iterations_;
    double tolerance_, relaxation_;
};

class Exactly final : public Method
{
public:
    Exactly(NewtonSolver& newton, const Solving& how) : newton_(newton), how_(how) {}
    Verdict find_impulses(Problem& problem) override { return verdict(newton_.solve(problem, how_)); }
    Verdict find_displacements(Problem& problem, double tolerance) override
    {
        Solving how = how_;
        how.tolerance = 0.1 * tolerance;
        return verdict(newton_.solve(problem, how));
    }

private:
    static Verdict verdict(const Solved& s) { return {s.steps + s.sweeps, s.residual, s.converged, s.fell_back}; }

    NewtonSolver& newton_;
    Solving how_;
};

/// As a fraction of a body's size per step (or of a rad): smaller violations are not reported.
constexpr double kMatters = 0x1p-23;

int whole(std::int64_t n) { return static_cast<int>(std::min<std::int64_t>(n, 1'000'000)); }

void report(Island& island, const Verdict& verdict)
{
    island.iterations = verdict.iterations, island.residual = verdict.residual;
    island.converged = verdict.converged, island.fell_back = verdict.fell_back;
}

/// Calls solve(number, island, memory) for each island (island_team.h). An interrupted solve leaves its memory in an undefined state, so it
/// is cleared.
template <class Memory, class Divides, class Solve>
void solve_all(const StepContext& context, const Bodies& bodies, const Shafts& shafts, std::span<Island> islands, IslandTeam<Memory>& team,
               const Divides& divides, const Solve& solve)
{
    team.advance(islands, {.bodies = bodies.size(), .shafts = shafts.size()}, context.workers, divides,
                 [&](std::size_t i, Memory& memory)
                 {
                     if (!islands[i].interrupted()) solve(i, islands[i], memory);
                 });
    if (context.interrupted()) team.clear();
}

bool always(std::size_t) { return true; }

template <class Rows>
void add_all(const StepContext& context, Row row, std::span<const Island> islands, Rows& rows)
{
    for (const Island& island : islands) rows.account.add(context, row, island, rows.tolerance[row]);
}

}  // namespace

void Account::describe(Schema& s)
{
    s.output(residual, "residual", unit::metre_per_second, "largest remaining violation of the velocity conditions of contacts and rows")
        .reported_as_error();
    s.output(iterations, "iterations", unit::one, "sweeps, sub-steps' sweeps or Newton steps in the last step");
    s.output(contacts, "contacts", unit::one, "contact points in the last step");
    s.output(fallbacks, "fallbacks", unit::one, "islands for which a fallback algorithm had to finish the last step");
    s.output(step, "step", unit::one, "the step that these outputs refer to; -1: none yet").or_else(-1);
    s.output(last_failure, "last_failure", unit::one,
             "the last step that did not converge; -1: none. An event reports the first of consecutive ones")
        .or_else(-1);
}

void Sleep::describe(Schema& s, double usual_after, double usual_speed)
{
    s.param(after, "sleep_after", unit::second, "islands at rest for so long sleep: they cost nothing until something wakes them; 0: never")
        .or_else(usual_after)
        .not_negative();
    s.param(speed, "sleep_speed", unit::metre_per_second, "a body of which a point may move faster does not rest")
        .or_else(usual_speed)
        .positive();
    s.output(asleep, "asleep", unit::one, "bodies of sleeping islands");
    s.output(reason, "sleep_reason", unit::one, "with sleep_after: what keeps islands awake whether they rest or not");
}

void Account::add(const StepContext& context, Row row, const Island& island, double tolerance)
{
    if (!context.events) return;
    if (step[row] != context.tick)
    {
        step[row] = context.tick;
        iterations[row] = contacts[row] = fallbacks[row] = 0, residual[row] = 0;
    }
    iterations[row] += island.iterations;
    contacts[row] += static_cast<std::int64_t>(island.contacts.size());
    fallbacks[row] += island.fell_back ? 1 : 0;
    residual[row] = std::max(residual[row], island.residual);
    // A violation that moves no body by more than 2^-23 of its size in a step appears in the output only, without an event.
    const double size = island.bodies.empty() ? 1 : island.size;
    if (island.converged || island.residual * island.h <= kMatters * size) return;
    const bool reported = last_failure[row] >= 0 && last_failure[row] + 1 >= context.tick;
    if (!reported)
        context.emit(row, "manager.not_converged", Severity::Warning,
                     "contacts violate their conditions by " + rounded_text(island.residual) + " m/s; the tolerance is " +
                         number_text(tolerance) + " m/s; allow more iterations, use a smaller dt, or choose a more exact manager",
                     {island.residual, tolerance});
    last_failure[row] = context.tick;
}

void SequentialRows::describe(Schema& s)
{
    s.param(max_iterations, "max_iterations", unit::one,
            "sweeps over the contacts and rows for velocities; up to ten times as many where contacts are new")
        .or_else(20)
        .positive()
        .at_most(kMostIterations);
    s.param(position_iterations, "position_iterations", unit::one, "sweeps that correct overlap")
        .or_else(10)
        .not_negative()
        .at_most(kMostIterations);
    s.param(tolerance, "tolerance", unit::metre_per_second,
            "remaining violation at which the sweeps end; a step with a larger one counts as not converged")
        .or_else(1e-6)
        .positive();
    s.param(slop, "slop", unit::metre,
            "overlap that is tolerated, and gaps held as if closed: contacts that vibrate by less than this "
            "persist")
        .or_else(5e-5)
        .not_negative();
    s.param(overlap_share, "overlap_share", unit::one,
            "fraction of the overlap beyond slop that is corrected in one step; a large one lifts the bodies "
            "that rest above and excites rocking")
        .or_else(0.2)
        .positive()
        .at_most(1);
    s.param(relaxation, "relaxation", unit::one,
            "fraction of each correction that is applied; values above 1 converge faster, or not at all")
        .or_else(1)
        .positive()
        .at_most(1.9);
    account.describe(s), sleep.describe(s);
    s.scratch(memory, "memory", "working memory");
}

void solve_all_sequentially(const StepContext& context, Row row, SequentialRows& rows, Bodies& bodies, Shafts& shafts,
                            std::span<Island> islands)
{
    StepChoices choices;
    choices.slop = rows.slop[row], choices.correction_share = rows.overlap_share[row];
    solve_all(context, bodies, shafts, islands, rows.memory[row], always,
              [&](std::size_t, Island& island, StepMemory& memory)
              {
                  Sweeps method(whole(rows.max_iterations[row]), whole(rows.position_iterations[row]), rows.tolerance[row],
                                rows.relaxation[row]);
                  memory.problem.workers = context.workers;
                  report(island, advance_island(island, bodies, shafts, method, choices, memory));
              });
    add_all(context, row, islands, rows);
}

void DirectRows::describe(Schema& s)
{
    s.param(tolerance, "tolerance", unit::metre_per_second,
            "violation that counts as zero; never less than the rounding error, about 1e-11 in a wall of 1000 "
            "bricks")
        .or_else(1e-13)
        .positive();
    s.param(max_steps, "max_steps", unit::one, "maximum number of Newton steps; after these, sweeps finish")
        .or_else(80)
        .positive()
        .at_most(10000);
    s.param(max_iterations, "max_iterations", unit::one,
            "sweeps in a row where Newton's method does not converge, up to four times; also in islands with "
            "more than max_contacts")
        .or_else(100)
        .positive()
        .at_most(kMostIterations);
    s.param(max_contacts, "max_contacts", unit::one,
            "islands with more contact points are solved by sweeps: a factorisation would cost too much")
        .or_else(20000)
        .positive()
        .at_most(1e6);
    account.describe(s), sleep.describe(s);
    s.scratch(memory, "memory", "working memory: factors of the island's matrix");
}

void solve_all_directly(const StepContext& context, Row row, DirectRows& rows, Bodies& bodies, Shafts& shafts, std::span<Island> islands)
{
    const Solving how{rows.tolerance[row], whole(rows.max_steps[row]), whole(rows.max_iterations[row])};
    const auto is_swept = [&](std::size_t i) { return islands[i].contacts.size() > static_cast<std::size_t>(rows.max_contacts[row]); };
    solve_all(context, bodies, shafts, islands, rows.memory[row], is_swept,
              [&](std::size_t i, Island& island, DirectRows::Memory& memory)
              {
                  memory.step.problem.workers = context.workers;
                  if (is_swept(i))
                  {
                      Sweeps method(how.most_sweeps, how.most_sweeps, std::max(1e-6, how.tolerance), 1);
                      report(island, advance_island(island, bodies, shafts, method, {}, memory.step));
                      island.fell_back = true;
                      return;
                  }
                  Exactly method(memory.newton, how);
                  report(island, advance_island(island, bodies, shafts, method, {}, memory.step));
              });
    add_all(context, row, islands, rows);
}

void SoftStepRows::describe(Schema& s)
{
    s.param(substeps, "substeps", unit::one, "number of sub-steps, each with one sweep followed by the relaxation sweeps")
        .or_else(8)
        .positive()
        .at_most(1000);
    s.param(relax_iterations, "relax_iterations", unit::one,
            "sweeps after each move that remove the velocity added by the correction of overlap")
        .or_else(1)
        .not_negative()
        .at_most(100);
    s.param(hertz, "hertz", kHertz, "stiffness of contacts as a natural frequency; limited to a quarter of the rate of the sub-steps")
        .or_else(60)
        .positive();
    s.param(damping_ratio, "damping_ratio", unit::one, "damping ratio of that oscillation").or_else(10).not_negative();
    s.param(push_speed, "push_speed", unit::metre_per_second, "largest speed at which overlap is pushed out").or_else(3).positive();
    s.param(tolerance, "tolerance", unit::metre_per_second,
            "largest speed at which overlap may still grow; with a larger one the contacts count as not held and "
            "the step as not converged")
        .or_else(1e-2)
        .positive();
    account.describe(s), sleep.describe(s);
    s.scratch(memory, "memory", "working memory");
}

void solve_all_softly(const StepContext& context, Row row, SoftStepRows& rows, Bodies& bodies, Shafts& shafts, std::span<Island> islands)
{
    const SoftChoices choices{whole(rows.substeps[row]), whole(rows.relax_iterations[row]),
                              rows.hertz[row],           rows.damping_ratio[row],
                              rows.push_speed[row],      rows.tolerance[row]};
    solve_all(context, bodies, shafts, islands, rows.memory[row], always,
              [&](std::size_t, Island& island, SoftMemory& memory)
              {
                  memory.step.problem.workers = context.workers;
                  report(island, advance_softly(island, bodies, shafts, choices, memory));
              });
    add_all(context, row, islands, rows);
}

void AutomaticRows::describe(Schema& s)
{
    // What Direct holds still moves by rounding alone, some 1e-13 m/s: it may sleep without a loss of digits. What SoftStep holds sways.
    constexpr double kRestsAfter = 0.5, kRestSpeed = 1e-9;  // s, m/s

    s.param(max_points, "max_points", unit::one,
            "an island of at most so many contact points and rows is solved exactly; up to 16 times as many if rows of joints are twice as "
            "many "
            "as contact points, as sweeps would let them stretch")
        .or_else(80)
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

constexpr std::size_t kHeavyPoints = 16;  // times max_points
/// An island at rest, or nearly so, is solved within these Newton steps. One that tumbles costs no more than they do: sweeps finish.
constexpr Solving kAffordable{1e-12, 12, 20, 1e-12};
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

AutomaticRows::Choice choose_method(const StepContext& context, const Island& island, const Bodies& bodies, const AutomaticRows& rows,
                                    Row row)
{
    const auto most = static_cast<std::size_t>(rows.max_points[row]), resting = static_cast<std::size_t>(rows.max_resting[row]);
    const auto joints = static_cast<std::size_t>(std::ranges::count(island.rows, RowKind::Equality, &ConstraintRow::kind));
    const std::size_t points = island.contacts.size() + island.rows.size() - joints;
    const double ratio = mass_ratio(island, bodies);
    // Sweeps let joints stretch under load, the more the longer the chain; a tree of joints costs a factorisation linear time. Where
    // contact points prevail, as in a heap of jointed bodies, each of them may change its state in each iteration, which costs far more.
    const bool yields = ratio >= rows.heavy[row] || 2 * points <= joints;
    const bool direct = points + joints <= most || (yields && points <= kHeavyPoints * most);
    const bool asks = !direct && points + joints <= resting;
    return {direct, asks ? worth_of_rest(island, bodies, context.tick) : 0, points, joints, ratio};
}

/// Solves an island exactly if that shows within `products` that it rests; otherwise nothing has been done, and the result is false.
bool holds_at_rest(std::size_t products, Island& island, Bodies& bodies, Shafts& shafts, AutomaticRows::Memory& memory)
{
    const Solving how{.tolerance = 1e-12, .most_steps = 30, .most_sweeps = 0, .rounds = 0, .most_products = products};
    StepChoices choices;
    choices.or_nothing = true;
    choices.correction_share = 0.2;  // what SoftStep has let sink is lifted slowly
    Exactly method(memory.direct.newton, how);
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
        return report(island, advance_softly(island, bodies, shafts, choices, memory.soft));
    }
    Exactly method(memory.direct.newton, kAffordable);
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
