#include "stepping.h"

#include <algorithm>
#include <cmath>

#include "plab/body_turn.h"
#include "plab/rotation.h"
#include "plab/row_speed.h"

namespace plab::managers
{

void Verdict::join(const Verdict& other)
{
    iterations += other.iterations;
    residual = std::max(residual, other.residual);
    converged = converged && other.converged;
    fell_back = fell_back || other.fell_back;
}

void keep_speeds(const Bodies& bodies, const Shafts& shafts, StepMemory& memory)
{
    memory.speeds.clear();
    for (const Anchor& m : memory.problem.anchors)
        if (m.shaft)
            memory.speeds.push_back({{}, {}, {}, shafts.speed[m.host]});
        else
            memory.speeds.push_back({bodies.velocity[m.host], bodies.angular_velocity[m.host], bodies.angular_momentum[m.host], 0});
}

void take_back_speeds(const StepMemory& memory, Bodies& bodies, Shafts& shafts)
{
    for (std::size_t i = 0; i < memory.speeds.size(); ++i)
    {
        const Anchor& m = memory.problem.anchors[i];
        const StepMemory::Speeds& s = memory.speeds[i];
        if (m.shaft)
            shafts.speed[m.host] = s.shaft;
        else
            bodies.velocity[m.host] = s.velocity, bodies.angular_velocity[m.host] = s.spin, bodies.angular_momentum[m.host] = s.momentum;
    }
}

void set_targets(Problem& problem, const Island& island, double h, double slop, Moving moving, std::span<const double> passing)
{
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        // A contact that carried an impulse may be held up to `slop` away. An approaching contact must close its gap, or it
        // would never bounce.
        const Contact& c = island.contacts[i];
        problem.points[i].least = c.turning + std::min(0.0, c.depth + (dot(c.impulse, c.normal) > 0 ? slop : 0.0)) / h;
    }
    for (std::size_t i = 0; i < passing.size(); ++i) problem.points[i].least = std::min(problem.points[i].least, passing[i]);
    set_line_targets(problem, island, h, moving);
    problem.aim_resistances(h / island.h);
}

Moving how_to_move(const Problem& problem, double h)
{
    constexpr double kStops = 4;  // h c / m: slower by exp(-4) at the end
    const auto stops = [&](const Line& line)
    {
        const ConstraintRow& row = problem.row_of(line);
        return row.kind == RowKind::ForceChange && h * row.damping * line.mobility > kStops;
    };
    return std::ranges::any_of(problem.lines, stops) ? Moving::ByEnd : Moving::ByMean;
}

void kick(Problem& problem, const Island& island, const Bodies& bodies, const Shafts& shafts, double h)
{
    problem.note_rolling(bodies);
    for (Line& line : problem.lines)
        if (const ConstraintRow& row = problem.row_of(line); row.kind == RowKind::ForceChange) line.before = speed_of(row, bodies, shafts);
    island.motion->kick(h);
}

namespace
{

/// theta of set_line_targets() for z = h c / m.
double share_of_end(double z)
{
    constexpr double kSmall = 1e-2;  // then the next term of the series, z^3 / 720, is below 2^-28
    return z < kSmall ? 0.5 + z / 12 : -1 / std::expm1(-z) - 1 / z;
}

/// Let v be the speed at the end and x the displacement halfway through the move, x = error + h (v_before + v) / 4 or error + h v / 2. The
/// impulse j = h (bias - stiffness x - damping (theta v + (1 - theta) v_before - rate)) is linear in v: j = without - g v, so that
/// v + j / g = without / g.
void set_force_target(Line& line, const ConstraintRow& row, double h, Moving moving)
{
    constexpr double kNothing = 0x1p-52;
    const bool by_mean = moving == Moving::ByMean;
    const double ahead = by_mean ? 0.25 * h : 0.5 * h, theta = share_of_end(h * row.damping * line.mobility);
    const double g = h * (row.stiffness * ahead + row.damping * theta);
    if (line.count == 0 || !(g * line.mobility > kNothing))
    {
        line.least = line.most = line.impulse = line.compliance = 0;
        return;
    }
    const double halfway = row.error + (by_mean ? ahead * line.before : 0.0);
    const double without = h * (row.bias - row.stiffness * halfway - row.damping * ((1 - theta) * line.before - row.rate));
    line.compliance = 1 / g, line.target = without / g;
}

}  // namespace

void note_move(const Problem& problem, const Island& island, double h, Moving moving)
{
    for (const Line& line : problem.lines)
    {
        if (problem.row_of(line).kind != RowKind::ForceChange || line.count == 0) continue;
        const double end = problem.rate(line);
        island.rows[line.row].error += h * (moving == Moving::ByMean ? 0.5 * (line.before + end) : end);
    }
}

void set_line_targets(Problem& problem, const Island& island, double h, Moving moving)
{
    problem.let_resist(true);
    for (Line& line : problem.lines)
    {
        if (line.resists()) continue;  // bound_resistances()
        const ConstraintRow& row = island.rows[line.row];
        const bool one_sided = row.kind == RowKind::OneSided;
        line.target = row.rate - (one_sided && row.error > 0 ? row.error / h : 0.0);
        line.least = std::max(one_sided ? 0.0 : -HUGE_VAL, row.lower * h), line.most = row.upper * h;
        if (row.kind == RowKind::ForceChange) set_force_target(line, row, h, moving);
        line.impulse = std::clamp(line.impulse, line.least, line.most);
    }
}

void store_impulses(const Problem& problem, Island& island)
{
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        const Point& p = problem.points[i];
        Contact& c = island.contacts[i];
        c.impulse = p.t1 * p.impulse.x + p.t2 * p.impulse.y + p.n * p.impulse.z;
        const Vec3 u = problem.relative_velocity(p);
        c.slip = std::hypot(u.x, u.y);
    }
    for (std::size_t i = 0; i < island.rows.size(); ++i) island.rows[i].impulse = problem.lines[i].impulse;
}

void add_impulses(const Problem& problem, Island& island)
{
    for (std::size_t i = 0; i < island.further_impulses.size(); ++i)
        island.further_impulses[i] += to_world(problem.points[i], problem.points[i].impulse);
}

void displace(const Problem& problem, Bodies& bodies, Shafts& shafts)
{
    for (std::size_t i = 0; i < problem.movers.size(); ++i)
    {
        const Anchor& m = problem.anchors[i];
        const Vec3 shift = problem.movers[i].v, turn = problem.movers[i].w;
        if (m.shaft)
        {
            shafts.angle[m.host] += turn.x;
            continue;
        }
        if (shift == Vec3{} && turn == Vec3{}) continue;
        bodies.position[m.host] += shift;
        turn_without_work(bodies, m.host, exp_rotation(turn));
    }
}

bool turns_only(const ConstraintRow& row)
{
    return std::all_of(row.blocks.begin(), row.blocks.begin() + row.count, [](const RowBlock& b) { return b.linear == Vec3{}; });
}

void move(const Problem& problem, const Island& island, const Verdict& found, double h, Moving moving)
{
    if (!found.converged && matters(found.residual, island, h)) moving = Moving::ByEnd;
    note_move(problem, island, h, moving);
    if (moving == Moving::ByMean)
        island.motion->move_mean(h);
    else
        island.motion->move(h);
}

}  // namespace plab::managers
