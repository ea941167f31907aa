/// What the managers do with the islands of a call, each by its method.
#pragma once

#include <span>

#include "island_team.h"
#include "newton.h"
#include "sequential.h"
#include "stepping.h"

namespace plab::managers
{

/// Finds impulses by Newton's method.
class Exactly final : public Method
{
public:
    Exactly(NewtonSolver& newton, const Solving& how, const Island& island) : newton_(newton), how_(how)
    {
        // What correct_positions() leaves alone need not be held more exactly in a step.
        const double fast = (island.bodies.empty() ? 1 : island.size) / island.h;
        how_.enough = kPositionTolerance * fast, how_.close = kClose * fast;
    }
    /// What resists rolling is solved with the normal impulses that the contacts had before, until these are what comes of it (Haslinger,
    /// Math. Methods Appl. Sci. 5 (1983), for friction). Where no solution is found so, the step does without.
    Verdict find_impulses(Problem& problem) override
    {
        constexpr int kMostRounds = 3;
        const auto bound = [&]
        {
            if (!problem.has_resistances()) return 0.0;
            const double change = problem.bound_resistances([&](std::uint32_t i) { return problem.points[i].impulse.z; });
            problem.apply_impulses();
            return change;
        };
        (void)bound();
        Verdict out = find_bounded(problem);
        for (int round = 0; round < kMostRounds && out.converged && bound() > how_.enough && !problem.interrupted(); ++round)
            again(problem, out);
        const bool or_nothing = how_.rounds == 0;
        if (out.converged || or_nothing || !problem.has_resistances()) return out;
        problem.let_resist(false);
        (void)bound();
        again(problem, out);
        out.fell_back = true;
        return out;
    }
    Verdict find_displacements(Problem& problem, double tolerance) override
    {
        Solving how = how_;
        how.tolerance = 0.1 * tolerance, how.enough = how.close = tolerance;
        how.locked = kKept;
        return verdict(newton_.solve(problem, how));
    }

private:
    void again(Problem& problem, Verdict& out)
    {
        const int before = out.iterations;
        out = find_bounded(problem), out.iterations += before;
    }
    Verdict find_bounded(Problem& problem)
    {
        Verdict out = verdict(newton_.solve(problem, how_));
        if (!gains_by_turning(problem)) return out;
        problem.forget_turning();
        const int before = out.iterations;
        out = verdict(newton_.solve(problem, how_)), out.iterations += before;
        return out;
    }

    static constexpr double kClose = 0x1p-24;  ///< of the size of the bodies in a step
    static constexpr double kKept = 1e-4;      ///< overlap that joints keep, but for so much, is left (leave_kept_overlap)
    static Verdict verdict(const Solved& s) { return {s.steps + s.sweeps, s.residual, s.converged, s.fell_back}; }

    NewtonSolver& newton_;
    Solving how_;
};

inline void report(Island& island, const Verdict& verdict)
{
    island.iterations = verdict.iterations, island.residual = verdict.residual;
    island.converged = verdict.converged, island.fell_back = verdict.fell_back;
}

/// Calls solve(number, island, memory) for each island (island_team.h). An interrupted solve leaves its memory in an undefined state, so it
/// is cleared.
template <class Memory, class Divides, class Solve>
void solve_all(const StepContext& context, const Bodies& bodies, const Shafts& shafts, std::span<Island> islands, IslandTeam<Memory>& team,
               const Divides& divides, const Solve& solve)
{
    team.advance(islands, {.bodies = bodies.size(), .shafts = shafts.size()}, context.workers, divides,
                 [&](std::size_t i, Memory& memory)
                 {
                     if (!islands[i].interrupted()) solve(i, islands[i], memory);
                 });
    if (context.interrupted()) team.clear();
}

}  // namespace plab::managers
