/// Solver/Automatic: picks a method for each group by a rule, from facts that it measures, and says which and why.
///
///   uniform forces, no joints                    Exact               (machine precision at any step)
///   stiff and linear, at most 60 numbers         Exponential         (exact; a step along which forces bend: Radau5)
///   stiff otherwise                              Radau5              (rtol 1e-9)
///   fast spin, no joints                         RotationSplitting 4
///   else                                         RungeKutta4         (the same bits as Solver/RungeKutta4)
///
/// Stiff: h |lambda| > 1 and |lambda| > 4 |w|, lambda the largest eigenvalue of df/dy by a power iteration that starts from
/// a fixed vector (7 evaluations, every 16 steps and at the start). Fast: h |w| > 0.05, looked at in each step.
/// A need that is met raises the choice at once; it falls at the end of 16 steps in which it stayed below a quarter of
/// these bounds, so that it does not flutter. The choice is state: trials, replays and rewound pieces of a step use it and
/// do not change it; lengths are those of whole steps. Groups that share one component share the most demanding choice
/// among them (but Exact, which is a group's own); give a stiff one a component of its own.
/// The output `resolved` names the method; the event solver.chosen tells of each choice but the first where that is
/// RungeKutta4, and not of Exact, which is no matter of degree.
/// Sources: Hairer, Wanner, Solving ordinary differential equations II, section IV.2 (stiffness detection); the bounds:
/// tests/unit/solvers/automatic_test.cpp.
#pragma once

#include "exponential.h"
#include "radau5.h"
#include "resolved.h"

namespace plab::solvers
{

/// In order of demand. Numbers are state: they do not change.
enum class Choice : std::int64_t
{
    Undecided = 0,
    RungeKutta4 = 1,
    RotationSplitting = 2,
    Exponential = 3,
    Radau5 = 4,
};

struct AutomaticRows
{
    Column<std::int64_t> choice;  ///< Choice
    Column<std::int64_t> need;    ///< most demanding Choice since the last look, by the lower bounds
    Column<std::int64_t> looked;  ///< tick of the last power iteration
    Column<std::int64_t> latest;  ///< tick of the last whole step
    Column<double> step;          ///< s, length of that
    Column<std::string> resolved;
    Column<double> spin, stiffness;  ///< h |w|, h |lambda|
    Column<ExponentialMemory> memory;

    void describe(Schema& schema);
};

/// One step over context.dt, from coordinates 0.
void advance_automatic(const StepContext& context, Row row, AutomaticRows& rows, DynamicSystem& system);

}  // namespace plab::solvers
