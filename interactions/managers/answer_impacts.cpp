// Impacts at the start of a step.
#include <algorithm>
#include <cmath>

#include "stepping.h"

namespace plab::managers
{
namespace
{

/// Fraction of the island's size: a gap up to this counts as touching while other contacts collide.
constexpr double kTouching = 0x1p-17;

bool meets(const Contact& c, double h) { return c.approach > 0 && (c.depth >= 0 || c.approach * h > -c.depth); }

/// A corner that meets a body beside other points of the same pair that press already, does not rebound, and is still clearly above it. If
/// the impact stopped it now, it would hang there and fall again. Instead the impact leaves it the speed that closes the gap in this step,
/// and the next step takes the rest. The bodies end where an impact at the right time would leave them, but for terms of second order; what
/// forces do to the speed until then is lost.
bool lands(const Island& island, std::size_t i)
{
    const std::span<const Contact> all = island.contacts;
    const Contact& c = all[i];
    if (c.restitution > 0 || !(c.depth < -kTouching * island.size)) return false;
    const auto is_other = [&](const Contact& other) { return other.a != c.a || other.b != c.b; };
    const auto first = std::find_if(all.rend() - static_cast<std::ptrdiff_t>(i), all.rend(), is_other).base();
    const auto end = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(i), all.end(), is_other);
    return std::any_of(first, end, [](const Contact& own) { return own.impulse != Vec3{}; });
}

/// Closing speed at which a limit is met: at its bound, or before it if it will rebound within the step; otherwise 0.
double closing(const Problem& problem, const Line& line, const ConstraintRow& row, double h)
{
    if (line.count == 0 || row.kind != RowKind::OneSided) return 0;
    const double speed = row.rate - problem.rate(line);
    const bool met = row.error <= 0 || (row.restitution > 0 && speed * h > row.error);
    return met ? std::max(0.0, speed) : 0.0;
}

/// Whether a stop or a contact returns a part of its closing speed.
bool any_rebound(const Problem& problem, const Island& island)
{
    const auto rebounds = [&](const Contact& c) { return c.restitution > 0 && meets(c, island.h); };
    if (std::any_of(island.contacts.begin(), island.contacts.end(), rebounds)) return true;
    return std::any_of(problem.lines.begin(), problem.lines.end(),
                       [&](const Line& line)
                       {
                           const ConstraintRow& row = problem.row_of(line);
                           return row.restitution > 0 && closing(problem, line, row, island.h) > 0;
                       });
}

bool any_impact(const Problem& problem, const Island& island)
{
    return any_rebound(problem, island) ||
           std::any_of(island.contacts.begin(), island.contacts.end(), [&](const Contact& c) { return meets(c, island.h); });
}

/// Moreau's law of impact: u_n' >= -e u_n at all touching contacts, also at those that separate. With one common e this law
/// never adds energy, and with e = 1 it conserves it. Requiring u_n' >= 0 at separating contacts would add energy.
void set_impact_targets(Problem& problem, const Island& island, std::span<const Vec3> before, double share)
{
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        const Contact& c = island.contacts[i];
        Point& p = problem.points[i];
        const double restitution = share * c.restitution;
        // With joints, the closing speed is that after settle_joints().
        if (meets(c, island.h))
            p.least = !problem.has_rows() && lands(island, i)
                          ? c.depth / island.h
                          : restitution * (!problem.has_rows() ? c.approach : std::min(c.approach, std::max(0.0, -before[i].z)));
        else
            p.least = c.depth >= -kTouching * island.size || c.impulse != Vec3{} ? -restitution * std::max(0.0, before[i].z) : kFar;
    }
    for (Line& line : problem.lines)
    {
        const ConstraintRow& row = problem.row_of(line);
        const bool one_sided = row.kind == RowKind::OneSided;
        const double speed = closing(problem, line, row, island.h);
        line.target = row.rate + share * row.restitution * speed;
        line.least = one_sided ? 0.0 : -HUGE_VAL, line.most = HUGE_VAL;
        // Nor has a limit an impulse that is not reached.
        if (!acts_at_once(row) || (one_sided && row.error > 0 && speed == 0)) line.least = line.most = 0;
    }
}

/// After a move the velocities fit the joints as they were at its start. The rest, of first order in the step, is no closing speed that an
/// impact may return: it is removed before, which costs energy and adds none.
Verdict settle_joints(Problem& problem, Bodies& bodies, Shafts& shafts, Method& method)
{
    const auto is_joint = [&](const Line& line) { return problem.row_of(line).kind == RowKind::Equality; };
    if (std::none_of(problem.lines.begin(), problem.lines.end(), is_joint)) return {};
    for (Point& p : problem.points) p.least = kFar;
    for (Line& line : problem.lines)
    {
        line.target = problem.row_of(line).rate;
        line.most = is_joint(line) ? HUGE_VAL : 0.0, line.least = -line.most;
    }
    const Verdict out = method.find_impulses(problem);
    problem.write_speeds(bodies, shafts);
    problem.read_speeds(bodies, shafts);
    problem.clear_impulses();
    problem.apply_impulses();
    return out;
}

/// The largest fraction, at most 1, of the impulses j that adds no kinetic energy, j u + j K j / 2, where u is the contact
/// velocity before.
double share_without_gain(const Problem& problem, std::span<const Vec3> before, std::span<const double> rates)
{
    double linear = 0, square = 0, size = 0;
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        const Point& p = problem.points[i];
        linear += dot(p.impulse, before[i]), square += dot(p.impulse, problem.relative_velocity(p) - before[i]);
        size += length(p.impulse) * length(before[i]);
    }
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        linear += line.impulse * rates[i], square += line.impulse * (problem.rate(line) - rates[i]);
        size += std::fabs(line.impulse * rates[i]);
    }
    return linear + 0.5 * square > 1e-11 * size ? std::max(0.0, -2 * linear / square) : 1.0;
}

}  // namespace

Verdict answer_impacts(Island& island, Bodies& bodies, Shafts& shafts, Method& method, StepMemory& memory)
{
    constexpr int kTrials = 6;
    Problem& problem = memory.problem;
    Verdict out;
    problem.read_speeds(bodies, shafts);
    problem.clear_impulses();
    problem.apply_impulses();
    memory.passing.clear(), memory.impacts.clear(), memory.line_impacts.clear();
    if (!any_impact(problem, island)) return out;
    problem.let_resist(false);
    if (any_rebound(problem, island)) out.join(settle_joints(problem, bodies, shafts, method));
    auto& before = memory.separations;
    before.clear(), memory.line_rates.clear();
    for (const Point& p : problem.points) before.push_back(problem.relative_velocity(p));
    for (const Line& line : problem.lines) memory.line_rates.push_back(problem.rate(line));
    // With friction, Newton's restitution may return more energy than there was, and so may sweeps that have not converged. A
    // small excess is removed by scaling the impulses; if it is large, a smaller restitution is tried, and finally none.
    constexpr double kLittle = 0.9;
    double share = 1;
    for (int trial = 1;; ++trial)
    {
        set_impact_targets(problem, island, before, share);
        out.join(method.find_impulses(problem));
        const double fits = share_without_gain(problem, before, memory.line_rates);
        if (fits >= kLittle || share == 0)
        {
            if (fits < 1) problem.scale_impulses(fits), problem.apply_impulses();
            break;
        }
        share = trial < kTrials ? 0.5 * share : 0.0;
        problem.clear_impulses();
        problem.apply_impulses();
    }
    for (const Point& p : problem.points)
        memory.passing.push_back(p.least > kFar ? std::min(0.0, p.least) : 0.0), memory.impacts.push_back(to_world(p, p.impulse));
    for (const Line& line : problem.lines) memory.line_impacts.push_back(line.impulse);
    problem.write_speeds(bodies, shafts);
    return out;
}

}  // namespace plab::managers
