#include "joint_hold.h"

#include <algorithm>

namespace plab::managers
{
namespace
{

/// m/s, relative to the island's size per step: speeds below are left to the next step.
constexpr double kHeld = 0x1p-30;

}  // namespace

bool has_joints(const Island& island)
{
    return std::ranges::any_of(island.rows, [](const ConstraintRow& row) { return row.kind == RowKind::Equality; });
}

void hold_joint_speeds(Problem& problem, Island& island, Bodies& bodies, Shafts& shafts, NewtonSolver& newton)
{
    const double size = island.bodies.empty() ? 1 : island.size;
    island.motion->refresh_rows();
    problem.turn_with(bodies);
    problem.turn_lines();
    problem.read_speeds(bodies, shafts);
    problem.clear_impulses();
    problem.apply_impulses();
    set_joint_targets(problem, island);
    newton.solve_joints(problem, kHeld * size / island.h);
    problem.write_speeds(bodies, shafts);
}

void close_joints(Problem& problem, Island& island, Bodies& bodies, Shafts& shafts, NewtonSolver& newton)
{
    const double length = island.bodies.empty() ? 1 : island.size;
    for (int n = 0; n < kMostCorrections; ++n)
    {
        if (n > 0) island.motion->refresh_rows(), problem.turn_lines();
        const double apart = set_displacements_of_lines(problem, island, length);
        if (apart <= (n == 0 ? kPositionTolerance : kJointsApart) * length) return;
        for (Line& line : problem.lines)
            if (island.rows[line.row].kind != RowKind::Equality) line.least = line.most = 0;
        problem.turn_with(bodies);
        problem.rest();
        problem.clear_impulses();
        problem.apply_impulses();
        newton.solve_joints(problem, kPositionTolerance * length);
        limit_turns(problem);
        displace(problem, bodies, shafts);
    }
}

}  // namespace plab::managers
