#include "sequential.h"

#include <algorithm>
#include <cmath>

namespace plab::managers
{
namespace
{

double relax(Problem& problem, Point& p, double relaxation)
{
    if (!(p.K(2, 2) > 0)) return 0;
    Vec3 u = problem.relative_velocity(p);
    const Vec3 before = p.impulse;
    p.impulse.z = std::max(0.0, before.z - relaxation * (u.z - p.least) / p.K(2, 2));
    if (p.frictional())
    {
        // The tangential part uses the new normal impulse immediately.
        const double change = p.impulse.z - before.z;
        u.x += p.K(0, 2) * change, u.y += p.K(1, 2) * change;
        const double share = relaxation / p.slip_mobility;
        const Vec3 held = within_disc({before.x - share * u.x, before.y - share * u.y, 0}, p.friction * p.impulse.z);
        p.impulse.x = held.x, p.impulse.y = held.y;
    }
    const Vec3 change = p.impulse - before;
    if (change == Vec3{}) return 0;
    problem.push(p, change);
    return std::max(std::fabs(change.z) * p.K(2, 2), std::max(std::fabs(change.x), std::fabs(change.y)) * p.slip_mobility);
}

double relax(Problem& problem, Line& line, double relaxation)
{
    if (line.count == 0) return 0;
    const double before = line.impulse;
    line.impulse = std::clamp(before - relaxation * (problem.rate(line) - line.target) / line.mobility, line.least, line.most);
    const double change = line.impulse - before;
    if (change == 0) return 0;
    problem.push(line, change);
    return std::fabs(change) * line.mobility;
}

}  // namespace

bool is_driven(const Problem& problem)
{
    const auto pushed = [](const Point& p) { return p.given != Vec3{} || p.least > 0; };
    const auto driven = [](const Line& line)
    { return line.count > 0 && (line.given != 0 || line.target > 0 || (line.target != 0 && line.least < 0)); };
    return std::any_of(problem.points.begin(), problem.points.end(), pushed) ||
           std::any_of(problem.lines.begin(), problem.lines.end(), driven);
}

bool makes_energy(const Problem& problem)
{
    return !is_driven(problem) && kinetic_energy(problem) > kinetic_energy_without(problem) * (1 + 1e-9);
}

double sweep_once(Problem& problem, double relaxation, bool backwards)
{
    double largest = 0;
    const auto visit = [&](auto& list)
    {
        const std::size_t n = list.size();
        for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, relax(problem, list[backwards ? n - 1 - i : i], relaxation));
    };
    visit(problem.lines);
    visit(problem.points);
    return largest;
}

Swept sweep(Problem& problem, const Sweeping& how)
{
    Swept out;
    while (out.sweeps < how.most && !out.converged && !problem.interrupted())
    {
        // Alternates the direction of the sweeps: rocking modes that one direction hardly damps decay in the other.
        out.change = sweep_once(problem, how.relaxation, out.sweeps % 2 == 1);
        ++out.sweeps;
        out.converged = out.change <= how.tolerance;
    }
    return out;
}

Swept sweep_without_gain(Problem& problem, const Sweeping& how)
{
    Swept out = sweep(problem, how);
    if (out.converged || !makes_energy(problem)) return out;
    problem.clear_impulses();
    problem.apply_impulses();
    const int before = out.sweeps;
    out = sweep(problem, how);
    out.sweeps += before;
    return out;
}

}  // namespace plab::managers
