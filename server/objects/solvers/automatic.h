/// Solver/Automatic: picks a method for each group and each step by a rule, from facts that it measures, and says which and why.
///
///   uniform forces, no joints            Exact                (machine precision at any step)
///   stiff, linear, few numbers that move Exponential          (exact at any step)
///   stiff otherwise                      Radau5               (rtol 1e-9)
///   stiff and large                      DormandPrince54      (explicit: many short internal steps)
///   fast spin, no joints                 RotationSplitting 4
///   else                                 RungeKutta4          (the same bits as Solver/RungeKutta4)
///
/// Stiff: |h lambda| > 0.5 and > 4 |w| h of some member, as the step of RungeKutta4 itself shows (facts.h): if it does, the step is
/// taken back and made anew, so nothing blows up first, and what is not stiff pays nothing. Fast: h |w| > 0.05.
/// The choice depends on the start of the advance and its length alone: rewinds, trials and replays choose the same, groups
/// that share the component do not see one another, and nothing has to be saved.
/// The output `resolved` names the methods of the last steps, `reason` says why the last new one was taken; the event
/// solver.chosen tells of each method once, but of RungeKutta4 and Exact, which are no surprise.
/// Sources: Hairer, Wanner, Solving ordinary differential equations II, section IV.2 (stiffness detection); the bounds:
/// tests/unit/solvers/automatic_test.cpp.
#pragma once

#include "dormand_prince54.h"
#include "exponential.h"
#include "radau5.h"
#include "resolved.h"

namespace plab::solvers
{

struct AutomaticMemory
{
    ExponentialMemory exponential;  ///< Radau5's too
    DormandPrinceMemory dormand;
    std::int64_t before = 0, shown = 0;  ///< methods of the step before, and those that `resolved` names, as bits
    std::size_t call = 0;                ///< turns in this step
};

struct AutomaticRows
{
    Column<std::string> resolved, reason;
    Column<double> spin, stiffness;              ///< h |w|, |h lambda|
    Column<std::int64_t> methods, last_methods;  ///< used since the run began; in the last step; as bits
    Column<Tick> step;                           ///< the last one
    Column<Integers> soft_turns;                 ///< by turn in the last step: 1 where the group was not stiff
    Column<AutomaticMemory> memory;

    void describe(Schema& schema);
};

/// Several groups in one system, if all of them would choose Exact, or all RungeKutta4; refuses otherwise, with the state at the
/// start.
Result<void> advance_together(const StepContext& context, Row row, AutomaticRows& rows, DynamicSystem& system);

/// One step over context.dt, from coordinates 0.
void advance_automatic(const StepContext& context, Row row, AutomaticRows& rows, DynamicSystem& system);

}  // namespace plab::solvers
