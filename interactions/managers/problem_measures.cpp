// How far a problem is from the contact law, and its energies.
#include <algorithm>
#include <cmath>

#include "problem.h"

namespace plab::managers
{

// Active contacts are judged by their velocity itself: next to a large impulse, a small change of impulse would be lost to
// rounding.
double violation(const Point& p, const Vec3& u)
{
    if (!(p.K(2, 2) > 0)) return 0;
    const bool presses = p.impulse.z - (u.z - p.least) / p.K(2, 2) > 0;
    const double of_normal = presses ? std::fabs(u.z - p.least) : std::fabs(p.impulse.z) * p.K(2, 2);
    if (!p.frictional()) return of_normal;
    const double k = p.slip_mobility, x = p.impulse.x - u.x / k, y = p.impulse.y - u.y / k, size = std::hypot(x, y);
    const double radius = p.friction * std::max(0.0, p.impulse.z);
    if (size <= radius) return std::max(of_normal, std::hypot(u.x, u.y));
    const double share = radius / size;
    return std::max(of_normal, std::hypot(x * share - p.impulse.x, y * share - p.impulse.y) * k);
}

// A row with much compliance hardly moves anything: what counts is the speed by which it would.
double violation(const Line& line, double gap)
{
    if (line.count == 0) return 0;
    const double wanted = line.impulse - gap / line.admittance();
    const double held = std::clamp(wanted, line.least, line.most);
    return held == wanted ? std::fabs(gap) * (line.mobility / line.admittance()) : std::fabs(held - line.impulse) * line.mobility;
}

double kinetic_energy(const Problem& problem)
{
    return 0.5 * problem.sum_over_movers([&](std::size_t i)
                                         { return twice_energy(problem.anchors[i], problem.movers[i].v, problem.movers[i].w); });
}

double kinetic_energy_without(const Problem& problem)
{
    return 0.5 * problem.sum_over_movers([&](std::size_t i)
                                         { return twice_energy(problem.anchors[i], problem.anchors[i].v, problem.anchors[i].w); });
}

double violation(const Problem& problem)
{
    double largest = 0;
    for (const Point& p : problem.points) largest = std::max(largest, violation(p, problem.relative_velocity(p)));
    for (const Line& line : problem.lines) largest = std::max(largest, violation(line, problem.gap(line)));
    return largest;
}

}  // namespace plab::managers
