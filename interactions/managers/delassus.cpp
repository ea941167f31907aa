#include "delassus.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "joint_solver.h"
#include "sequential.h"
#include "stiffness.h"

namespace plab::managers
{
namespace
{

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Of all factorisations of a solve, in cubes of the number of impulses: 34 of the largest ones.
constexpr double kMostWork = 2.4e8;
/// Summands of Problem::rounding.
constexpr double kTerms = 4096;

}  // namespace

Vec3 DelassusSolver::velocity(const Place& place) const
{
    const double* u = &u_[place.first];
    return place.count == 1 ? Vec3{0, 0, u[0]} : Vec3{u[0], u[1], u[2]};
}

double DelassusSolver::gap(std::size_t k) const
{
    const Line& line = lines_[k];
    return u_[places_[k].first] + line.compliance * line.impulse - line.target;
}

/// Writes r to the points and rows, and sets u = q + W r.
void DelassusSolver::find_velocities()
{
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        const double* r = &r_[places_[k].first];
        if (places_[k].line)
            lines_[k].impulse = r[0];
        else
            points_[k].impulse = places_[k].count == 1 ? Vec3{0, 0, r[0]} : Vec3{r[0], r[1], r[2]};
    }
    velocities_with(r_, u_);
}

/// to += W r.
void DelassusSolver::add_responses(std::span<const double> r, std::span<double> to) const
{
    for (std::size_t c = 0; c < size_; ++c)
        if (r[c] != 0)
            for (std::size_t i = 0; i < size_; ++i) to[i] += W(i, c) * r[c];
}

void DelassusSolver::velocities_with(std::span<const double> r, std::span<double> u) const
{
    std::copy(q_.begin(), q_.end(), u.begin());
    add_responses(r, u);
}

double DelassusSolver::residual() const
{
    double largest = 0;
    for (std::size_t k = 0; k < places_.size(); ++k)
        largest = std::max(largest, places_[k].line ? violation(lines_[k], gap(k)) : violation(points_[k], velocity(places_[k])));
    return largest;
}

/// m/s: what rounding leaves of the sums u.
double DelassusSolver::rounding() const
{
    double largest = 0;
    for (std::size_t i = 0; i < size_; ++i)
    {
        double sum = std::fabs(q_[i]);
        for (std::size_t c = 0; c < size_; ++c) sum += std::fabs(W(i, c) * r_[c]);
        largest = std::max(largest, sum);
    }
    return 16 * kEpsilon * largest;
}

bool DelassusSolver::changes_pieces()
{
    bool changes = false;
    pieces_.resize(places_.size());
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        const char now = places_[k].line ? piece_of(lines_[k], gap(k)) : piece_of(points_[k], velocity(places_[k]));
        changes = changes || pieces_[k] != now;
        pieces_[k] = now;
    }
    return changes;
}

/// Adds g times a row of W to one of the matrix.
void DelassusSolver::add_row(std::uint32_t row, std::uint32_t of, double g)
{
    if (g == 0) return;
    linear::SquareMatrix<double>& A = factors_.matrix();
    for (std::size_t c = 0; c < size_; ++c) A(row, c) += g * W(of, c);
}

/// (1 + G W) dr = change.
bool DelassusSolver::find_step(double kappa)
{
    linear::SquareMatrix<double>& A = factors_.matrix();
    A.resize(size_);
    std::ranges::fill(A.all(), 0.0);
    step_.assign(size_, 0.0);
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        const std::uint32_t f = places_[k].first;
        if (places_[k].line)
        {
            const LineLaw law = law_of(lines_[k], gap(k), kappa);
            step_[f] = law.change;
            add_row(f, f, law.G);
            continue;
        }
        const PointLaw law = law_of(points_[k], velocity(places_[k]), kappa);
        const std::uint32_t skip = 3 - places_[k].count;
        for (std::uint32_t i = skip; i < 3; ++i)
        {
            step_[f + i - skip] = law.change[i];
            for (std::uint32_t j = skip; j < 3; ++j) add_row(f + i - skip, f + j - skip, law.G(i, j));
        }
    }
    for (std::size_t i = 0; i < size_; ++i) A(i, i) += 1;
    if (!factorise()) return false;
    factors_.solve(step_);
    return std::ranges::all_of(step_, [](double s) { return std::isfinite(s); });
}

bool DelassusSolver::factorise()
{
    work_ += static_cast<double>(size_ * size_ * size_);
    return factors_.factorise();
}

/// Whether nothing more is to be tried.
bool DelassusSolver::is_spent() const { return work_ > kMostWork || (interruption_ && interruption_->due()); }

void DelassusSolver::go(double share)
{
    for (std::size_t i = 0; i < size_; ++i) r_[i] += share * step_[i];
    find_velocities();
}

/// Newton's method from r; ends at the best r that it finds. Returns its residual.
double DelassusSolver::newton(double tolerance, int most, Found& out)
{
    constexpr int kHalvings = 4, kPatience = 5;
    double now = residual(), best = now;
    Stiffness stiffness;
    best_ = r_, contradicts_ = false;
    (void)changes_pieces();
    // One step at least: a residual within the tolerance, added up over many steps of the island, may still be a drift.
    for (int i = 0, since_best = 0; i < most && !is_spent() && since_best < kPatience && (i == 0 || best > tolerance);
         ++i, ++since_best, ++out.steps)
    {
        if (!find_step(stiffness.kappa())) break;
        const double before = now;
        double at = 1;
        go(1);
        now = residual();
        for (int n = 0; n < kHalvings && !(now < kTooFar * before); ++n)
        {
            go(-0.5 * at);
            at *= 0.5, now = residual();
        }
        const bool same = !changes_pieces();
        contradicts_ = stiffness.makes_no_difference(same, before, now);
        stiffness.adapt(same, before, now, tolerance);
        if (now < 0.5 * best) since_best = -1;
        if (now < best) best = now, best_ = r_;
        if (contradicts_) break;
    }
    r_ = best_;
    find_velocities();
    return best;
}

void DelassusSolver::change(std::size_t at, double by)
{
    if (by == 0) return;
    r_[at] += by;
    for (std::size_t i = 0; i < size_; ++i) u_[i] += W(i, at) * by;
}

/// Satisfies the law of one point or row, with all others as they are.
void DelassusSolver::relax(std::size_t k)
{
    const std::uint32_t f = places_[k].first;
    if (places_[k].line)
    {
        Line& line = lines_[k];
        if (line.count == 0) return;
        const double held = std::clamp(line.impulse - gap(k) / line.admittance(), line.least, line.most);
        change(f, held - line.impulse);
        line.impulse = held;
        return;
    }
    Point& p = points_[k];
    const std::uint32_t n = f + places_[k].count - 1;
    const double normal = std::max(0.0, p.impulse.z - (u_[n] - p.least) / p.K(2, 2));
    change(n, normal - p.impulse.z);
    p.impulse.z = normal;
    if (!p.frictional()) return;
    const Vec3 wanted{p.impulse.x - u_[f] / p.slip_mobility, p.impulse.y - u_[f + 1] / p.slip_mobility, normal};
    const Vec3 held = within_disc(wanted, p.friction * normal);
    change(f, held.x - p.impulse.x), change(f + 1, held.y - p.impulse.y);
    p.impulse = held;
}

void DelassusSolver::sweep(int times)
{
    for (int n = 0; n < times; ++n)
        for (std::size_t k = 0; k < places_.size(); ++k) relax(n % 2 == 0 ? k : places_.size() - 1 - k);
    find_velocities();
}

bool DelassusSolver::find_impulses(const Bounds& bounds, Found& out)
{
    constexpr int kSteps = 30, kRounds = 20, kSweeps = 100, kMostSweeps = 4000;
    find_velocities();
    contradicts_ = false;
    // From no impulses Newton's method may find one of several solutions or another, as rounding has it.
    const bool is_warm = std::ranges::any_of(r_, [](double r) { return r != 0; });
    double left = residual();
    if (!is_warm && left <= bounds.tolerance) return true;
    if (is_warm) left = newton(std::max(bounds.tolerance, rounding()), kSteps, out);
    if (is_warm && (left <= std::max(bounds.tolerance, rounding()) || (contradicts_ && left <= bounds.enough))) return true;
    if (share_anew(left, bounds, out)) return true;
    for (int round = 0; round < kRounds && out.sweeps < kMostSweeps && !is_spent(); ++round)
    {
        sweep(kSweeps);
        out.sweeps += kSweeps;
        const double tolerance = std::max(bounds.tolerance, rounding());
        left = newton(tolerance, kSteps, out);
        if (left <= std::max({tolerance, bounds.enough, bounds.close})) return true;
    }
    return false;
}

/// Forgets how contacts shared their load. Where more of them stick than the mechanism has ways to move, they contradict one another by a
/// trifle (the wheels of a car are not parallel to the last digit): then friction is at its bounds here and there, and in each step at
/// other places. From no load, soft contacts that become stiffer share it evenly. If that does not come close, r becomes the better of
/// what it was, with the residual `left`, and what has been found.
bool DelassusSolver::share_anew(double left, const Bounds& bounds, Found& out)
{
    constexpr int kRounds = 7, kSteps = 20, kGrowth = 8;
    guess_ = r_;
    std::ranges::fill(r_, 0.0);
    find_velocities();
    double kappa = 100;
    for (int i = 0; i < kRounds; ++i, kappa *= kGrowth)
    {
        if (!round(kappa, bounds.tolerance, out)) break;
        const double tolerance = std::max(bounds.tolerance, rounding());
        if (newton(tolerance, kSteps, out) <= std::max({tolerance, bounds.enough, bounds.close})) return true;
    }
    if (!(residual() < left)) r_ = guess_;
    find_velocities();
    return false;
}

/// What resists rolling follows the normal impulses that come of it (Exactly::find_impulses), with the same W.
bool DelassusSolver::find_with_resistances(Problem& problem, const Bounds& bounds, Found& out)
{
    constexpr int kMostRounds = 3;
    bool found = find_impulses(bounds, out);
    for (int round = 0; round < kMostRounds && found && bound_resistances(problem) > bounds.enough && !is_spent(); ++round)
        found = find_impulses(bounds, out);
    return found;
}

/// Like Problem::bound_resistances(), of which it sets the bounds as well.
double DelassusSolver::bound_resistances(Problem& problem)
{
    double largest = 0;
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        Line& line = lines_[k];
        if (!places_[k].line || !line.resists() || line.count == 0) continue;
        double load = 0;
        for (std::size_t i = 0; i < places_.size(); ++i)
            if (!places_[i].line && places_[i].index >= line.first_point && places_[i].index < line.end_point) load += points_[i].impulse.z;
        const double change = line.set_bound(line.lever * load, r_[places_[k].first]);
        largest = std::max(largest, change * line.mobility);
        Line& own = problem.lines[places_[k].index];
        own.least = line.least, own.most = line.most;
        r_[places_[k].first] = std::clamp(r_[places_[k].first], line.least, line.most);
    }
    find_velocities();
    return largest;
}

/// From no impulses, each sweep takes energy.
void DelassusSolver::sweep_from_none(Found& out)
{
    constexpr int kSweeps = 1000;
    std::ranges::fill(r_, 0.0);
    find_velocities();
    sweep(kSweeps);
    out.sweeps += kSweeps;
}

/// Gives their impulses to the joints, or everything back to the problem.
void DelassusSolver::finish(Problem& problem, const Bounds& bounds, Found& out)
{
    const auto give_back = [&]
    {
        for (std::size_t i = 0; i < problem.points.size(); ++i) problem.points[i].impulse = guess_points_[i];
        for (std::size_t i = 0; i < problem.lines.size(); ++i) problem.lines[i].impulse = guess_lines_[i];
        problem.apply_impulses();
        out.solved = false;
    };
    if (!out.solved || !std::ranges::all_of(r_, [](double r) { return std::isfinite(r); })) return give_back();
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
        if (joints_->holds()[i] != 0) problem.lines[i].impulse = joints_->impulse(i);
    problem.apply_impulses();
    joints_->correct(problem);
    problem.apply_impulses();
    const double most = std::max({bounds.tolerance, bounds.enough, bounds.close, problem.rounding(kTerms)});
    if (!out.fell_back && !(violation(problem) <= most)) give_back();
}

DelassusSolver::Found DelassusSolver::solve(Problem& problem, const Bounds& bounds)
{
    constexpr int kMostRounds = 12;
    Found out;
    joints_ = has_forces(problem) ? &with_forces_ : &without_forces_;
    if (!joints_->shape(problem) || !joints_->factor(problem)) return out;
    interruption_ = problem.interruption, work_ = 0;
    guess_points_.clear(), guess_lines_.clear();
    for (const Point& p : problem.points) guess_points_.push_back(p.impulse);
    for (const Line& line : problem.lines) guess_lines_.push_back(line.impulse);
    point_in_.assign(problem.points.size(), 0);
    line_in_.assign(joints_->holds().begin(), joints_->holds().end());
    places_.clear(), r_.clear(), size_ = 0;
    W_.resize(kMostImpulses * kMostImpulses);
    find_free(problem);
    for (int round = 0; round < kMostRounds && !out.solved; ++round)
    {
        const std::size_t known = places_.size();
        if (!add_missing(problem, std::max(bounds.close, bounds.tolerance))) out.solved = true;
        if (out.solved || size_ > kMostImpulses) break;
        find_columns(problem, known);
        find_free(problem);
        if (!set_up(problem, bounds.locked)) break;
        out.fell_back = !find_with_resistances(problem, bounds, out);
        if (out.fell_back && bounds.or_nothing) break;
        take_velocities(problem);
        if (!out.fell_back || !makes_energy(problem)) continue;
        sweep_from_none(out);
        take_velocities(problem);
    }
    finish(problem, bounds, out);
    return out;
}

}  // namespace plab::managers
