#include "manager_rows.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "advance_island.h"
#include "plab/number_text.h"
#include "solve_islands.h"

namespace plab::managers
{
namespace
{

/// With this many iterations, a step of some hundred contacts still ends within minutes.
constexpr double kMostIterations = 100'000;

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
    Sweeps(int iterations, int position_iterations, double tolerance, double relaxation, JointSolver& joints)
        : iterations_(iterations),
          position_iterations_(position_iterations),
          tolerance_(tolerance),
          relaxation_(relaxation),
          joints_(joints)
    {
    }
    Verdict find_impulses(Problem& problem) override
    {
        const Sweeping how{static_cast<int>(iterations_ * (1 + 9 * unknown_share(problem))), 0.1 * tolerance_, relaxation_, 1, true};
        Swept done = sweep_rows(problem, how);
        if (gains_by_turning(problem))
        {
            problem.forget_turning();
            const int before = done.sweeps;
            done = sweep_rows(problem, how), done.sweeps += before;
        }
        const double residual = violation(problem);
        return {done.sweeps, residual, residual <= tolerance_, false};
    }
    Verdict find_displacements(Problem& problem, double tolerance) override
    {
        const Sweeping how{position_iterations_, tolerance, relaxation_};
        const Swept done = holds_rows(problem) ? sweep_between_rows(problem, how) : sweep(problem, how);
        problem.apply_impulses();
        return {done.sweeps, 0, true, false};
    }

private:
    /// Sweeps pass a load on from row to row, so that a chain stretches and a car drags its wheels. A tree of joints is held exactly at the
    /// cost of a few of them; so are stiff forces, which need hundreds.
    bool holds_rows(const Problem& problem)
    {
        if (std::ranges::none_of(problem.lines,
                                 [](const Line& line) { return !line.resists() && line.count > 0 && line.least < line.most; }))
            return false;
        joints_.load(problem);
        return has_forces(problem) || joints_.is_cheap(problem);
    }
    Swept sweep_rows(Problem& problem, const Sweeping& how)
    {
        const Swept done = holds_rows(problem) ? sweep_between_rows(problem, how) : sweep_without_gain(problem, how);
        problem.apply_impulses();
        return done;
    }
    /// Joints and forces are held exactly between some sweeps.
    Swept sweep_between_rows(Problem& problem, Sweeping how)
    {
        constexpr int kAtOnce = 8;
        Swept out;
        joints_.hold(problem, how.tolerance);
        for (const int most = std::exchange(how.most, kAtOnce); out.sweeps < most && !out.converged && !problem.interrupted();)
        {
            const Swept some = sweep(problem, how);
            out.sweeps += some.sweeps, out.change = some.change, out.converged = some.converged;
            joints_.hold(problem, how.tolerance);
        }
        return out;
    }

    int iterations_, position_iterations_;
    double tolerance_, relaxation_;
    JointSolver& joints_;
};

int whole(std::int64_t n) { return static_cast<int>(std::min<std::int64_t>(n, 1'000'000)); }

bool always(std::size_t) { return true; }

/// s: what failed a shorter time ago belongs to the same heap that tumbles.
constexpr double kQuiet = 0.5;

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
             "the last step that did not converge; -1: none. An event reports the first one after half a second without")
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
    // A violation that does not matter appears in the output only, without an event.
    if (island.converged || !matters(island.residual, island, island.h)) return;
    const Tick quiet = 1 + static_cast<Tick>(kQuiet / context.dt);
    const bool reported = last_failure[row] >= 0 && last_failure[row] + quiet >= context.tick;
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
                                rows.relaxation[row], memory.joints);
                  memory.problem.workers = context.workers;
                  report(island, advance_island(island, bodies, shafts, method, choices, memory));
              });
    add_all(context, row, islands, rows);
}

void DirectRows::describe(Schema& s)
{
    s.param(tolerance, "tolerance", unit::metre_per_second,
            "violation that counts as zero; never less than the rounding error, about 1e-11 in a wall of 1000 bricks. Where Newton's "
            "method gets no further, what moves no body by more than 2^-30 of its size in a step counts as zero too")
        .or_else(1e-13)
        .positive();
    s.param(max_steps, "max_steps", unit::one,
            "maximum number of Newton steps; after these, sweeps finish. Mechanisms of many joints have a bound of their own, on work")
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
                      Sweeps method(how.most_sweeps, how.most_sweeps, std::max(1e-6, how.tolerance), 1, memory.step.joints);
                      report(island, advance_island(island, bodies, shafts, method, {}, memory.step));
                      island.fell_back = true;
                      return;
                  }
                  Exactly method(memory.newton, how, island);
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

}  // namespace plab::managers
