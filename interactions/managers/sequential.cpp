#include "sequential.h"

#include <algorithm>
#include <cmath>

namespace plab::managers
{
namespace
{

double relax(Problem& problem, Line& line, double relaxation)
{
    if (line.count == 0) return 0;
    const double before = line.impulse;
    line.impulse = std::clamp(before - relaxation * problem.gap(line) / line.admittance(), line.least, line.most);
    const double change = line.impulse - before;
    if (change == 0) return 0;
    problem.push(line, change);
    return std::fabs(change) * line.mobility;
}

}  // namespace

bool is_driven(const Line& line) { return line.count > 0 && (line.given != 0 || line.target > 0 || (line.target != 0 && line.least < 0)); }

bool is_driven(const Problem& problem)
{
    const auto pushed = [](const Point& p) { return p.given != Vec3{} || p.least > 0; };
    return std::any_of(problem.points.begin(), problem.points.end(), pushed) ||
           std::any_of(problem.lines.begin(), problem.lines.end(), [](const Line& line) { return is_driven(line); });
}

namespace
{

/// J: what impulses that satisfy the rows may give because levers turn within the step: with those of its middle, velocities u at its ends
/// are not 0 but t = -turning. The impulses j give j (u_before + t) / 2 = j t - j W j / 2, W = J M^-1 J^T, so no more than j t.
double given_by_turning(const Problem& problem)
{
    double sum = 0;
    for (const Point& p : problem.points) sum -= dot(p.impulse, p.turning);
    for (const Line& line : problem.lines) sum -= line.impulse * line.turning;
    return std::max(0.0, sum);
}

}  // namespace

bool makes_energy(const Problem& problem)
{
    if (is_driven(problem)) return false;
    return kinetic_energy(problem) > kinetic_energy_without(problem) * (1 + 1e-9) + given_by_turning(problem);
}

bool gains_by_turning(const Problem& problem)
{
    constexpr double kMost = 0x1p-6;
    if (!problem.has_rows() || problem.points.empty() || is_driven(problem)) return false;
    return kinetic_energy(problem) > kinetic_energy_without(problem) * (1 + kMost);
}

template <int W>
Swept sweep(Problem& problem, PacketList<W>& list, const Sweeping& how)
{
    Swept out;
    while (out.sweeps < how.most && !out.converged && !problem.interrupted())
    {
        // Alternates the direction of the sweeps: rocking modes that one direction hardly damps decay in the other.
        const bool backwards = out.sweeps % 2 == 1;
        const std::size_t lines = problem.lines.size();
        out.change = how.loads_resist ? problem.bound_resistances([&](std::uint32_t k) { return list.impulse(k).z; }) : 0.0;
        for (std::size_t i = 0; i < lines; ++i)
            out.change = std::max(out.change, relax(problem, problem.lines[backwards ? lines - 1 - i : i], how.relaxation));
        out.change = std::max(out.change, sweep_hard(list, std::span<Mover>(problem.movers),
                                                     {how.tolerance > 0, how.relaxation, how.friction_scale, backwards}));
        ++out.sweeps;
        out.converged = how.tolerance > 0 && out.change <= how.tolerance;
    }
    return out;
}
template Swept sweep(Problem&, PacketList<1>&, const Sweeping&);
template Swept sweep(Problem&, PacketList<4>&, const Sweeping&);

Swept sweep(Problem& problem, const Sweeping& how)
{
    const auto with = [&](auto& list)
    {
        list.load(problem.points, problem.movers.size(), problem.workers);
        set_mobility(list, std::span<const Mover>(problem.movers));
        const Swept out = sweep(problem, list, how);
        list.store(problem.points);
        return out;
    };
    return problem.points.size() > kSweptInOrder ? with(problem.fours) : with(problem.single);
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
