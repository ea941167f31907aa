#include "newton.h"

#include <algorithm>
#include <cmath>

#include "stiffness.h"

namespace plab::managers
{
namespace
{

/// Square root of the sum of the squared violations: smooth enough to compare steps by.
double total_violation(const Problem& problem)
{
    double sum = 0;
    const auto take = [&sum](double v) { sum += v * v; };
    for (const Point& p : problem.points) take(violation(p, problem.relative_velocity(p)));
    for (const Line& line : problem.lines) take(violation(line, problem.gap(line)));
    return std::sqrt(sum);
}

/// Whether each point is within `tolerance` of the law; `total` is the result of total_violation.
bool settled(const Problem& problem, double total, double tolerance)
{
    if (total <= tolerance) return true;
    const auto n = static_cast<double>(problem.points.size() + problem.lines.size());
    return total <= tolerance * std::sqrt(n) && violation(problem) <= tolerance;
}

bool is_large(const Problem& problem) { return problem.points.size() + problem.row_count() > 256; }

/// Number of summands for Problem::rounding: loads add up over the contacts of the island. In large islands some contacts carry
/// no load and change their state with every rounding error.
double terms_of(const Problem& problem)
{
    return (is_large(problem) ? 4096 : 16) * static_cast<double>(problem.points.size() + problem.lines.size());
}

/// Whether Newton's method, where it gets no further, has come close enough.
bool is_enough(const Problem& problem, const Solving& how) { return how.rounds > 0 && violation(problem) <= how.enough; }

bool is_warm(const Problem& problem)
{
    return std::any_of(problem.points.begin(), problem.points.end(), [](const Point& p) { return p.impulse.z > 0; }) ||
           std::any_of(problem.lines.begin(), problem.lines.end(), [](const Line& line) { return line.impulse != 0; });
}

/// Whether contacts hold a mechanism in many ways (start_anew).
bool may_share_loads(const Problem& problem)
{
    constexpr std::size_t kFewestPoints = 4, kMostPoints = 64;
    const std::size_t points = !problem.has_rows() || is_large(problem) ? 0 : problem.points.size();
    return points >= kFewestPoints && points <= kMostPoints;
}

/// Whether joints prevail: of a heap with a joint in it sweeps make less work.
bool is_mechanism(const Problem& problem) { return std::ranges::count_if(problem.lines, is_joint) >= std::ssize(problem.points); }

/// Whether joints are so many that a step of Newton's method on all movers costs more than one on the contacts alone.
bool has_many_joints(const Problem& problem)
{
    constexpr std::ptrdiff_t kManyRows = 64;
    return std::ranges::count_if(problem.lines, is_joint) >= kManyRows;
}

}  // namespace

bool NewtonSolver::find_step(const Problem& problem, double kappa)
{
    matrix_.start(problem);
    step_.assign(problem.movers.size(), Column6{});
    laws_.resize(problem.points.size()), line_laws_.resize(problem.lines.size());
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        const Point& p = problem.points[i];
        laws_[i] = law_of(p, problem.relative_velocity(p), kappa);
        add_push(step_, p, laws_[i].change);
        if (laws_[i].G(2, 2) != 0) matrix_.add(problem, i, laws_[i].G);
    }
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        line_laws_[i] = law_of(line, problem.gap(line), kappa);
        add_push(step_, line, line_laws_[i].change);
        if (line_laws_[i].G != 0) matrix_.add(problem, i, line_laws_[i].G);
    }
    if (!matrix_.solve(step_)) return false;
    // dj = P(tau) - j - G J dv.
    point_steps_.resize(problem.points.size()), line_steps_.resize(problem.lines.size());
    for (std::size_t i = 0; i < problem.points.size(); ++i)
        point_steps_[i] = laws_[i].change - laws_[i].G * relative_velocity_of(step_, problem.points[i]);
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
        line_steps_[i] = line_laws_[i].change - line_laws_[i].G * rate_of(step_, problem.lines[i]);
    return true;
}

void NewtonSolver::go(Problem& problem, double share)
{
    for (std::size_t i = 0; i < problem.points.size(); ++i) problem.points[i].impulse += point_steps_[i] * share;
    for (std::size_t i = 0; i < problem.lines.size(); ++i) problem.lines[i].impulse += line_steps_[i] * share;
    problem.apply_impulses();
}

/// Takes the whole step if it does not diverge, otherwise a part of it.
double NewtonSolver::advance(Problem& problem, double now)
{
    constexpr int kHalvings = 4;
    double at = 1;
    go(problem, 1);
    double residual = total_violation(problem);
    for (int i = 0; i < kHalvings && !(residual < kTooFar * now); ++i)
    {
        go(problem, -0.5 * at);
        at *= 0.5;
        residual = total_violation(problem);
    }
    return residual;
}

void NewtonSolver::remember(const Problem& problem)
{
    best_points_.clear(), best_lines_.clear();
    for (const Point& p : problem.points) best_points_.push_back(p.impulse);
    for (const Line& line : problem.lines) best_lines_.push_back(line.impulse);
}

/// Remembers the present impulses for recall_guess(), whatever newton() remembers in between.
void NewtonSolver::keep_guess(const Problem& problem)
{
    remember(problem);
    guess_points_ = best_points_, guess_lines_ = best_lines_;
}

void NewtonSolver::recall_guess(Problem& problem)
{
    best_points_ = guess_points_, best_lines_ = guess_lines_;
    recall(problem);
}

void NewtonSolver::recall(Problem& problem) const
{
    for (std::size_t i = 0; i < problem.points.size(); ++i) problem.points[i].impulse = best_points_[i];
    for (std::size_t i = 0; i < problem.lines.size(); ++i) problem.lines[i].impulse = best_lines_[i];
    problem.apply_impulses();
}

bool NewtonSolver::changes_pieces(const Problem& problem)
{
    bool changes = false;
    pieces_.resize(problem.points.size() + problem.lines.size());
    auto piece = pieces_.begin();
    const auto take = [&](char now) { changes = changes || *piece != now, *piece++ = now; };
    for (const Point& p : problem.points) take(piece_of(p, problem.relative_velocity(p)));
    for (const Line& line : problem.lines) take(piece_of(line, problem.gap(line)));
    return changes;
}

bool NewtonSolver::newton(Problem& problem, const Solving& how, Solved& out)
{
    constexpr int kPatience = 4;
    double now = total_violation(problem), best = now;
    Stiffness stiffness;
    remember(problem);
    (void)changes_pieces(problem);
    for (int since_best = 0; out.steps < how.most_steps && since_best < kPatience && !settled(problem, now, how.tolerance);)
    {
        if (!find_step(problem, stiffness.kappa())) break;
        const double before = now;
        now = advance(problem, now);
        ++out.steps, ++since_best;
        const bool same = !changes_pieces(problem);
        if (stiffness.makes_no_difference(same, before, now) && now > problem.rounding(terms_of(problem))) break;
        if (now > kTooFar * before && stiffness.lower())
        {
            recall(problem);
            now = best;
            (void)changes_pieces(problem);
            continue;
        }
        stiffness.adapt(same, before, now, how.tolerance);
        if (!(now < best)) continue;
        if (now < 0.5 * best) since_best = 0;
        best = now;
        remember(problem);
    }
    if (!(now <= best)) recall(problem);
    // How much rounding leaves can be estimated only once the impulses are known.
    Solving within = how;
    within.tolerance = std::max(how.tolerance, problem.rounding(terms_of(problem)));
    if (!settled(problem, best, within.tolerance)) return stiffness.is_useless() && violation(problem) <= how.enough;
    polish(problem, best, stiffness.kappa(), within, out);
    return true;
}

/// A residual within the tolerance, or within the rounding error of the largest impulse, may still be a load that a much lighter
/// body would notice. Further steps take each contact down to its own rounding error.
void NewtonSolver::polish(Problem& problem, double best, double kappa, const Solving& how, Solved& out)
{
    constexpr double kFine = 1e-2;
    const double coarse = problem.rounding() / how.finest;
    const int most = coarse > 1 ? 3 : 1;
    // Raises the stiffness in the ratio in which rounding is coarser than asked for: heavy bodies then converge, and redundant
    // contacts keep their shares.
    if (coarse > 1) kappa = std::max(kappa, std::min(kMostStiffness, kUsualStiffness * coarse));
    for (int i = 0; i < most && best > kFine * how.finest; ++i, ++out.steps)
    {
        if (!find_step(problem, kappa)) return;
        remember(problem);
        go(problem, 1);
        const double now = total_violation(problem);
        if (!(now <= best) && !settled(problem, now, how.tolerance)) return recall(problem);
        best = now;
    }
}

/// Contacts remember their impulses from step to step, joints do not. Joints that hold with what the contacts did last are close to the
/// solution wherever a mechanism goes on as it did. False if nothing was done.
bool NewtonSolver::hold_joints(Problem& problem, double tolerance)
{
    const auto presses = [](const Point& p) { return p.impulse.z > 0; };
    if (std::ranges::none_of(problem.points, presses) || std::ranges::none_of(problem.lines, is_joint)) return false;
    // Forces as stiff as those of servos would be found to fewer digits.
    if (has_forces(problem)) return false;
    joints_.load(problem);
    if (!joints_.is_cheap(problem)) return false;
    joints_.hold(problem, tolerance);
    problem.apply_impulses();
    return true;
}

/// Forgets how contacts shared their load. Where more of them stick than hold their bodies, a mechanism that moves asks of them what rigid
/// bodies cannot do by a trifle (the wheels of a car are not parallel to the last digit): then friction is at its bounds here and there,
/// and in each step at other places, where Newton's method goes round in circles. From no load, soft contacts that become stiffer share it
/// evenly. Leaves everything as it was unless it comes close.
bool NewtonSolver::start_anew(Problem& problem, const Solving& how, Solved& out)
{
    constexpr int kRounds = 4, kSteps = 60, kGrowth = 8;
    keep_guess(problem);
    for (Point& p : problem.points) p.impulse = {};
    problem.apply_impulses();
    Solving own = how;
    own.most_steps = out.steps + kSteps;
    double kappa = 100;
    for (int i = 0; i < kRounds && out.steps < own.most_steps; ++i, kappa *= kGrowth)
    {
        if (!lagrangian_.round(problem, matrix_, kappa, false, how.tolerance, out.steps)) break;
        if (newton(problem, own, out)) return true;
        if (violation(problem) > how.close) continue;
        // A trifle of slip is none, but joints would come apart.
        joints_.hold_without_gain(problem, how.tolerance);
        if (violation(problem) <= how.close) return true;
    }
    recall_guess(problem);
    return false;
}

/// Rounds of the augmented Lagrangian with growing stiffness, until Newton's method on the law itself converges.
void NewtonSolver::approach(Problem& problem, const Solving& how, Solved& out)
{
    constexpr double kFirst = 100, kGrowth = 4, kMost = 6400;
    constexpr int kRounds = 40, kSweeps = 16;
    const double guess = total_violation(problem);
    keep_guess(problem);
    // The first round starts as if all contacts stuck: for most piles at rest this is already the solution.
    (void)lagrangian_.round(problem, matrix_, 1e5, true, how.tolerance, out.steps);
    out.ended = newton(problem, how, out) || is_enough(problem, how);
    if (out.ended) return;
    if (!(total_violation(problem) < guess)) recall_guess(problem);
    out.sweeps += sweep(problem, {kSweeps, how.tolerance, 1}).sweeps;
    problem.apply_impulses();
    double kappa = kFirst;
    for (int i = 0; i < kRounds && !out.ended && out.steps < how.most_steps; ++i)
    {
        const bool there = lagrangian_.round(problem, matrix_, kappa, false, how.tolerance, out.steps);
        kappa = there ? std::min(kMost, kGrowth * kappa) : kappa / kGrowth;
        if (there)
            out.ended = newton(problem, how, out) || is_enough(problem, how);
        else
            problem.apply_impulses();
    }
}

/// Alternates Gauss-Seidel sweeps with Newton's method: each can leave a point at which the other stagnates.
void NewtonSolver::finish_by_sweeps(Problem& problem, const Solving& how, Solved& out)
{
    constexpr int kNewtonSteps = 12;
    for (int round = 0; round < how.rounds && !out.converged; ++round)
    {
        out.sweeps += sweep_without_gain(problem, {how.most_sweeps, how.tolerance, 1}).sweeps;
        problem.apply_impulses();
        joints_.hold_without_gain(problem, how.tolerance);
        out.residual = violation(problem);
        out.converged = out.residual <= how.tolerance;
        if (out.converged || round + 1 == how.rounds) return;
        Solving again = how;
        again.most_steps = out.steps + kNewtonSteps;
        (void)newton(problem, again, out);
        out.residual = violation(problem);
        out.converged = out.residual <= std::max(how.tolerance, how.enough);
    }
}

/// An island at rest drifts off its solution by rounding, a little in each step. When the drift exceeds the tolerance, a few
/// sweeps remove most of it. Newton's method would instead switch the state of barely loaded contacts back and forth.
bool NewtonSolver::settles_by_sweeps(Problem& problem, double guess, const Solving& how, Solved& out)
{
    constexpr double kNear = 100;
    constexpr int kSweeps = 24;
    const auto n = static_cast<double>(problem.points.size() + problem.lines.size());
    if (!is_large(problem) || !(guess <= kNear * how.tolerance * std::sqrt(n)) || problem.rounding() > how.finest) return false;
    remember(problem);
    out.sweeps += sweep(problem, {kSweeps, 0.1 * how.tolerance, 1}).sweeps;
    problem.apply_impulses();
    if (settled(problem, total_violation(problem), how.tolerance)) return true;
    recall(problem);
    return false;
}

/// A mechanism is solved in the impulses of its contacts alone. With `or_nothing` only if that satisfies the law.
bool NewtonSolver::solve_mechanism(Problem& problem, const Solving& how, bool or_nothing, Solved& out)
{
    const DelassusSolver::Found found =
        mechanism_.solve(problem, {how.tolerance, how.enough, how.close, how.locked, or_nothing || how.rounds == 0});
    if (!found.solved) return false;
    out.steps += found.steps, out.sweeps += found.sweeps;
    out.ended = true, out.fell_back = found.fell_back;
    out.residual = violation(problem);
    out.converged = out.residual <= std::max({how.tolerance, problem.rounding(terms_of(problem)), how.enough, how.close});
    return true;
}

Solved NewtonSolver::solve(Problem& problem, const Solving& how)
{
    Solved out;
    const bool many = has_many_joints(problem);
    if (many && solve_mechanism(problem, how, false, out)) return out;
    Solving exact = how;
    exact.finest = how.tolerance;
    const double terms = terms_of(problem);
    const auto set_tolerance = [&] { exact.tolerance = std::max(how.tolerance, problem.rounding(terms)); };
    set_tolerance();
    const bool held = hold_joints(problem, how.tolerance);
    const double guess = total_violation(problem);
    // Joints that are held within the tolerance are not yet as exact as a Newton step makes them.
    if (!held && settled(problem, guess, exact.tolerance))
    {
        // The result is as good as rounding of the largest impulse allows, but light bodies may need more.
        if (problem.rounding() > how.tolerance && guess > how.tolerance)
            matrix_.shape(problem), polish(problem, guess, kUsualStiffness, how, out);
    }
    else
    {
        if (is_warm(problem)) out.ended = settles_by_sweeps(problem, guess, exact, out);
        if (!out.ended) matrix_.shape(problem);
        const std::size_t affordable = how.most_products / std::max<std::size_t>(1, matrix_.products());
        exact.most_steps = static_cast<int>(std::min(affordable, static_cast<std::size_t>(how.most_steps)));
        if (!out.ended && is_warm(problem))
        {
            out.ended = newton(problem, exact, out);
            const int before = out.steps;
            if (!out.ended && may_share_loads(problem)) out.ended = start_anew(problem, exact, out);
            exact.most_steps += out.steps - before;
        }
        if (!out.ended) approach(problem, exact, out);
        set_tolerance();
    }
    out.residual = violation(problem);
    out.converged = out.residual <= std::max(exact.tolerance, out.ended ? std::max(how.enough, how.close) : 0.0);
    if (out.converged) return out;
    if (!many && is_mechanism(problem) && solve_mechanism(problem, how, true, out)) return out;
    out.fell_back = true;
    if (how.rounds == 0) return out;
    finish_by_sweeps(problem, exact, out);
    return out;
}

}  // namespace plab::managers
