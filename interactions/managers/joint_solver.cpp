#include "joint_solver.h"

#include <algorithm>
#include <cmath>

#include "sequential.h"

namespace plab::managers
{
namespace
{

constexpr double kStiffness = 1e6;  // of more, rounding in a chain under a load of some hundred times its links' mass makes nonsense
constexpr int kRounds = 8;
constexpr double kNotKnown = -1;  // a stiffness before the first round, for which there is no matrix yet
// Of blocks for each mover: a tree of joints takes some two, a small net tens, a large one hundreds.
constexpr std::size_t kFewProducts = 64;

/// What the row alone would make of its impulse at the present velocities, if it had no bounds.
double wanted_impulse(const Problem& problem, const Line& line) { return line.impulse - problem.gap(line) / line.admittance(); }

/// Whether that is within its bounds; for joints it always is.
bool acts_freely(const Problem& problem, const Line& line)
{
    if (line.count == 0 || line.resists() || !(line.least < line.most)) return false;
    const double wanted = wanted_impulse(problem, line);
    return wanted >= line.least && wanted <= line.most;
}

}  // namespace

/// Sets up the matrix of the rows that act freely. Returns whether other rows do so than before.
bool JointSolver::choose(const Problem& problem)
{
    bool changes = false;
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
        changes = changes || stiffness_[i] == kNotKnown || (stiffness_[i] != 0) != acts_freely(problem, problem.lines[i]);
    if (!changes) return false;
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
        stiffness_[i] = acts_freely(problem, problem.lines[i]) ? problem.lines[i].stiffness(kStiffness) : 0.0;
    matrix_.start(problem);
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
        if (stiffness_[i] != 0) matrix_.add(problem, i, stiffness_[i]);
    return true;
}

/// Returns the largest violation, m/s.
double JointSolver::find_changes(const Problem& problem)
{
    double worst = 0;
    step_.assign(problem.movers.size(), Column6{});
    changes_.assign(problem.lines.size(), 0.0);
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        if (line.count == 0 || line.resists()) continue;
        const double gap = problem.gap(line);
        worst = std::max(worst, violation(line, gap));
        changes_[i] =
            stiffness_[i] != 0 ? -stiffness_[i] * gap : std::clamp(wanted_impulse(problem, line), line.least, line.most) - line.impulse;
        add_push(step_, line, changes_[i]);
    }
    return worst;
}

void JointSolver::load(const Problem& problem) { matrix_.shape_of_rows(problem); }

bool JointSolver::is_cheap(const Problem& problem) const { return matrix_.products() <= kFewProducts * problem.movers.size(); }

void JointSolver::hold(Problem& problem, double tolerance)
{
    stiffness_.assign(problem.lines.size(), kNotKnown);
    hold_again(problem, tolerance);
}

void JointSolver::hold_again(Problem& problem, double tolerance)
{
    double before = HUGE_VAL;
    for (int round = 0; round < kRounds; ++round)
    {
        if (choose(problem))
        {
            before = HUGE_VAL;
            if (!matrix_.factor()) return;
        }
        const double worst = find_changes(problem);
        if (worst <= tolerance || !(worst < 0.5 * before) || !matrix_.substitute(step_)) return;
        before = worst;
        for (std::size_t i = 0; i < problem.lines.size(); ++i)
        {
            Line& line = problem.lines[i];
            const double old = line.impulse;
            line.impulse = std::clamp(old + changes_[i] - stiffness_[i] * rate_of(step_, line), line.least, line.most);
            if (line.impulse != old) problem.push(line, line.impulse - old);
        }
    }
}

void JointSolver::hold_without_gain(Problem& problem, double tolerance)
{
    constexpr int kHalvings = 4;
    if (std::none_of(problem.lines.begin(), problem.lines.end(), is_joint)) return;
    load(problem);
    const auto hold_and_sum = [&]
    {
        hold(problem, tolerance);
        problem.apply_impulses();
    };
    hold_and_sum();
    for (int n = 1; n <= kHalvings && makes_energy(problem); ++n)
    {
        const double share = n < kHalvings ? 0.5 : 0.0;
        for (Point& p : problem.points) p.impulse = p.impulse * share;
        problem.apply_impulses();
        hold_and_sum();
    }
}

}  // namespace plab::managers
