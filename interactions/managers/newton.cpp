#include "newton.h"

#include <algorithm>
#include <cmath>

namespace plab::managers
{
namespace
{

/// kappa of law_of: what a held contact's stiffness is, beside 1 / K.
constexpr double kLeastStiffness = 1e6, kMostStiffness = 1e12;

/// What one step asks of a point: dj = change - G du. Who presses and who slips is read off tau with rho = 1 / K, at which
/// impulses and speeds weigh alike; what presses or sticks is held by rho = kappa / K.
void law_of(const Point& p, const Vec3& u, double kappa, Vec3& change, Mat3& G)
{
    const double rho = 1 / p.K(2, 2), stiff = kappa * rho;
    G = {};
    change = -p.impulse;
    const double normal = p.impulse.z - rho * (u.z - p.least);
    if (normal <= 0) return;
    G(2, 2) = stiff;
    // Written so that a held contact's change is -rho u itself, without the digits of j.
    change.z = -stiff * (u.z - p.least);
    if (!p.frictional()) return;
    const double x = p.impulse.x - rho * u.x, y = p.impulse.y - rho * u.y, size = std::hypot(x, y);
    const double radius = p.friction * normal;
    if (size <= radius)
    {
        G(0, 0) = G(1, 1) = stiff;
        change.x = -stiff * u.x, change.y = -stiff * u.y;
        return;
    }
    // Along the slip mu j_n; across it the direction of tau turns with j and u. There j is rho u, as tau has no such part: so
    // the digits of j are not multiplied by a share that is large where slip begins.
    const double c = x / size, s = y / size, beta = radius / size;
    const double along = p.friction * (p.impulse.z + change.z) - (c * p.impulse.x + s * p.impulse.y);
    const double share = std::min(1 / (1 - beta), kappa), turn = rho * beta * share;
    const double across = -rho * (c * u.y - s * u.x) * share;
    change.x = along * c - across * s, change.y = along * s + across * c;
    G(0, 0) = turn * s * s, G(0, 1) = G(1, 0) = -turn * c * s, G(1, 1) = turn * c * c;
    G(0, 2) = p.friction * c * stiff, G(1, 2) = p.friction * s * stiff;
}

/// Root of the sum of squares: smooth enough to compare steps by.
double total_violation(const Problem& problem)
{
    double sum = 0;
    const auto take = [&sum](double v) { sum += v * v; };
    for (const Point& p : problem.points) take(violation(p, problem.relative_velocity(p)));
    for (const Line& line : problem.lines) take(violation(line, problem.rate(line)));
    return std::sqrt(sum);
}

/// Whether no point is further than that from the law; `total` is total_violation's.
bool settled(const Problem& problem, double total, double tolerance)
{
    if (total <= tolerance) return true;
    const auto n = static_cast<double>(problem.points.size() + problem.lines.size());
    return total <= tolerance * std::sqrt(n) && violation(problem) <= tolerance;
}

bool is_large(const Problem& problem) { return problem.points.size() + problem.lines.size() > 256; }

/// Loads add up over the island's contacts. Where they are many, some hold nothing and change their state with every rounding.
double terms_of(const Problem& problem)
{
    return (is_large(problem) ? 4096 : 16) * static_cast<double>(problem.points.size() + problem.lines.size());
}

bool is_warm(const Problem& problem)
{
    return std::any_of(problem.points.begin(), problem.points.end(), [](const Point& p) { return p.impulse.z > 0; }) ||
           std::any_of(problem.lines.begin(), problem.lines.end(), [](const Line& line) { return line.impulse != 0; });
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
        laws_[i] = {};
        if (!(p.K(2, 2) > 0)) continue;
        law_of(p, problem.relative_velocity(p), kappa, laws_[i].change, laws_[i].G);
        add_push(step_, p, laws_[i].change);
        if (laws_[i].G(2, 2) != 0) matrix_.add(problem, i, laws_[i].G);
    }
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        line_laws_[i] = {};
        if (line.count == 0) continue;
        const double rho = 1 / line.mobility, gap = problem.rate(line) - line.target, wanted = line.impulse - rho * gap;
        const double held = std::clamp(wanted, line.least, line.most);
        line_laws_[i] = held == wanted ? LineLaw{-kappa * rho * gap, kappa * rho} : LineLaw{held - line.impulse, 0};
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

/// The whole step if it does not lead away, or a part of it that does not.
double NewtonSolver::advance(Problem& problem, double now)
{
    constexpr int kHalvings = 4;
    double at = 1;
    go(problem, 1);
    double residual = total_violation(problem);
    for (int i = 0; i < kHalvings && !(residual < 2 * now); ++i)
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

void NewtonSolver::recall(Problem& problem) const
{
    for (std::size_t i = 0; i < problem.points.size(); ++i) problem.points[i].impulse = best_points_[i];
    for (std::size_t i = 0; i < problem.lines.size(); ++i) problem.lines[i].impulse = best_lines_[i];
    problem.apply_impulses();
}

bool NewtonSolver::newton(Problem& problem, const Solving& how, Solved& out)
{
    constexpr int kPatience = 4;
    constexpr double kGrowth = 1e2;
    double now = total_violation(problem), best = now, kappa = kLeastStiffness;
    remember(problem);
    for (int since_best = 0; out.steps < how.most_steps && since_best < kPatience && !settled(problem, now, how.tolerance);)
    {
        if (!find_step(problem, kappa)) break;
        const double before = now;
        now = advance(problem, now);
        ++out.steps, ++since_best;
        // Slow where masses differ much: then the contacts have to be taken as stiffer. Not at the floor of rounding, where it
        // would multiply what depths of redundant contacts disagree by.
        if (now > 0.05 * before && now > how.tolerance) kappa = std::min(kMostStiffness, kappa * kGrowth);
        if (!(now < best)) continue;
        if (now < 0.5 * best) since_best = 0;
        best = now;
        remember(problem);
    }
    if (!(now <= best)) recall(problem);
    // What rounding leaves is known once the impulses are.
    Solving within = how;
    within.tolerance = std::max(how.tolerance, problem.rounding(terms_of(problem)));
    if (!settled(problem, best, within.tolerance)) return false;
    polish(problem, best, kappa, within, out);
    return true;
}

/// What is left of tolerance, or of the rounding of the largest impulse, is a load that a lighter body does not see: steps
/// beyond it take each contact to the rounding of its own.
void NewtonSolver::polish(Problem& problem, double best, double kappa, const Solving& how, Solved& out)
{
    constexpr double kFine = 1e-2;
    const double coarse = problem.rounding() / how.finest;
    const int most = coarse > 1 ? 3 : 1;
    // As much stiffer as rounding is coarser: a heavy body gets there, and redundant contacts keep their shares.
    if (coarse > 1) kappa = std::max(kappa, std::min(kMostStiffness, kLeastStiffness * coarse));
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

/// Rounds of the augmented Lagrangian, ever stiffer, until Newton's method on the law itself takes over.
void NewtonSolver::approach(Problem& problem, const Solving& how, Solved& out)
{
    constexpr double kFirst = 100, kGrowth = 4, kMost = 6400;
    constexpr int kRounds = 40, kSweeps = 16;
    const double guess = total_violation(problem);
    remember(problem);
    guess_points_ = best_points_, guess_lines_ = best_lines_;
    // At first as if everything held fast: that is all there is to most things that lie.
    (void)lagrangian_.round(problem, matrix_, 1e5, true, how.tolerance, out.steps);
    out.converged = newton(problem, how, out);
    if (out.converged) return;
    if (!(total_violation(problem) < guess)) best_points_ = guess_points_, best_lines_ = guess_lines_, recall(problem);
    out.sweeps += sweep(problem, {kSweeps, how.tolerance, 1}).sweeps;
    problem.apply_impulses();
    double kappa = kFirst;
    for (int i = 0; i < kRounds && !out.converged && out.steps < how.most_steps; ++i)
    {
        const bool there = lagrangian_.round(problem, matrix_, kappa, false, how.tolerance, out.steps);
        kappa = there ? std::min(kMost, kGrowth * kappa) : kappa / kGrowth;
        if (there)
            out.converged = newton(problem, how, out);
        else
            problem.apply_impulses();
    }
}

/// Gauss-Seidel, and Newton's method again from where it got: each gets away from where the other is stuck.
void NewtonSolver::finish_by_sweeps(Problem& problem, const Solving& how, Solved& out)
{
    constexpr int kRounds = 4, kNewtonSteps = 12;
    for (int round = 0; round < kRounds && !out.converged; ++round)
    {
        out.sweeps += sweep_without_gain(problem, {how.most_sweeps, how.tolerance, 1}).sweeps;
        problem.apply_impulses();
        out.residual = violation(problem);
        out.converged = out.residual <= how.tolerance;
        if (out.converged || round + 1 == kRounds) return;
        Solving again = how;
        again.most_steps = out.steps + kNewtonSteps;
        if (newton(problem, again, out)) out.residual = violation(problem), out.converged = out.residual <= how.tolerance;
    }
}

/// What rests drifts off its solution by rounding, a little in each step. Where that shows, some sweeps take the most of it away:
/// Newton's method would change the state of contacts that hardly press to and fro.
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

Solved NewtonSolver::solve(Problem& problem, const Solving& how)
{
    Solved out;
    Solving exact = how;
    exact.finest = how.tolerance;
    const double terms = terms_of(problem);
    const auto set_tolerance = [&] { exact.tolerance = std::max(how.tolerance, problem.rounding(terms)); };
    set_tolerance();
    const double guess = total_violation(problem);
    if (settled(problem, guess, exact.tolerance))
    {
        // Good as far as rounding lets one see: a heavy body may see further.
        if (problem.rounding() > how.tolerance && guess > how.tolerance)
            matrix_.shape(problem), polish(problem, guess, kLeastStiffness, how, out);
    }
    else
    {
        if (is_warm(problem)) out.converged = settles_by_sweeps(problem, guess, exact, out);
        if (!out.converged) matrix_.shape(problem);
        if (!out.converged && is_warm(problem)) out.converged = newton(problem, exact, out);
        if (!out.converged) approach(problem, exact, out);
        set_tolerance();
    }
    out.residual = violation(problem);
    out.converged = out.residual <= exact.tolerance;
    if (out.converged) return out;
    out.fell_back = true;
    finish_by_sweeps(problem, exact, out);
    return out;
}

}  // namespace plab::managers
