/// The component types Manager/*: each advances islands of contacts and one-sided rows. Each call of Phase::Solve takes one step
/// of some islands.
#pragma once

#include <cstdint>

#include "island_team.h"
#include "newton.h"
#include "plab/context.h"
#include "plab/schema.h"
#include "soft_step.h"
#include "stepping.h"

namespace plab::managers
{

/// The outputs that every manager reports for its last step, summed over its islands.
struct Account
{
    Column<std::int64_t> iterations, contacts, fallbacks;
    Column<double> residual;  // m/s
    Column<Tick> step, last_failure;

    void describe(Schema& schema);

    /// Does nothing in trial steps: these are rewound, so they must leave neither outputs nor events behind.
    void add(const StepContext& context, Row row, const Island& island, double tolerance);
};

/// When islands of this manager sleep (server/docs/sleeping.md). The host reads the parameters by their names, decides, and writes the
/// output.
struct Sleep
{
    Column<double> after;  // s
    Column<double> speed;  // m/s
    Column<std::int64_t> asleep;
    Column<std::string> reason;

    /// By default nothing sleeps; but a manager may say otherwise (s, m/s).
    void describe(Schema& schema, double usual_after = 0, double usual_speed = 0.01);
};

struct SequentialRows
{
    Column<std::int64_t> max_iterations, position_iterations;
    Column<double> tolerance, relaxation, slop, overlap_share;
    Account account;
    Sleep sleep;
    Column<IslandTeam<StepMemory>> memory;

    void describe(Schema& schema);
};
void solve_all_sequentially(const StepContext& context, Row row, SequentialRows& rows, Bodies& bodies, Shafts& shafts,
                            std::span<Island> islands);

struct DirectRows
{
    Column<double> tolerance;
    Column<std::int64_t> max_steps, max_iterations, max_contacts;
    Account account;
    Sleep sleep;
    struct Memory
    {
        StepMemory step;
        NewtonSolver newton;
        void reserve(const IslandSize& size) { step.reserve(size); }
    };
    Column<IslandTeam<Memory>> memory;

    void describe(Schema& schema);
};
void solve_all_directly(const StepContext& context, Row row, DirectRows& rows, Bodies& bodies, Shafts& shafts, std::span<Island> islands);

struct SoftStepRows
{
    Column<std::int64_t> substeps, relax_iterations;
    Column<double> hertz, damping_ratio, push_speed, tolerance;
    Account account;
    Sleep sleep;
    Column<IslandTeam<SoftMemory>> memory;

    void describe(Schema& schema);
};
void solve_all_softly(const StepContext& context, Row row, SoftStepRows& rows, Bodies& bodies, Shafts& shafts, std::span<Island> islands);

/// Contact points up to which an island is solved exactly, unless a scene says otherwise.
inline constexpr int kSolvedExactly = 80;

/// Manager/Automatic: exact where that is affordable, and of a fixed cost where an island is large.
///
///   an island of at most `max_points` contact points and rows                     Direct
///   with bodies that are `heavy` times heavier than others, at most 16 x as many  Direct      (sweeps would let them sink)
///   with rows of joints twice as many as contact points                           Direct      (sweeps would let them stretch)
///   that rests, of at most `max_resting`, as Newton's method soon finds           Direct
///   otherwise                                                                     SoftStep    (8 sub-steps)
///
/// The choice follows from the island alone, so rewinds, trials and replays make the same one.
struct AutomaticRows
{
    Column<std::int64_t> max_points, max_resting;
    Column<double> heavy, tolerance;
    Column<std::string> resolved, reason;
    Column<std::int64_t> direct_islands, soft_islands;  ///< in the last step
    Account account;
    Sleep sleep;
    struct Memory
    {
        DirectRows::Memory direct;
        SoftMemory soft;
        void reserve(const IslandSize& size) { direct.reserve(size), soft.reserve(size); }
    };
    /// What was chosen for an island, and why.
    struct Choice
    {
        bool direct = false;
        bool presses = false;                ///< a stiff servo or spring acts
        std::size_t tries = 0;               ///< products of blocks that finding out whether it rests may take; 0: nobody asks
        std::size_t points = 0, joints = 0;  ///< contact points and rows that may yield; rows of joints
        double ratio = 1;
    };
    Column<IslandTeam<Memory>> memory;
    Column<std::vector<Choice>> choices;  ///< by island

    void describe(Schema& schema);
};
void solve_all_automatically(const StepContext& context, Row row, AutomaticRows& rows, Bodies& bodies, Shafts& shafts,
                             std::span<Island> islands);

/// The same for a single island.
inline void solve_sequential(const StepContext& context, Row row, SequentialRows& rows, Bodies& bodies, Shafts& shafts, Island& island)
{
    solve_all_sequentially(context, row, rows, bodies, shafts, {&island, 1});
}
inline void solve_direct(const StepContext& context, Row row, DirectRows& rows, Bodies& bodies, Shafts& shafts, Island& island)
{
    solve_all_directly(context, row, rows, bodies, shafts, {&island, 1});
}
inline void solve_soft_step(const StepContext& context, Row row, SoftStepRows& rows, Bodies& bodies, Shafts& shafts, Island& island)
{
    solve_all_softly(context, row, rows, bodies, shafts, {&island, 1});
}

}  // namespace plab::managers
