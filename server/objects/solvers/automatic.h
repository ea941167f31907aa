/// Solver/Automatic: selects a method for each group and each step by a rule, from measured properties, and reports which and why.
///
///   uniform forces, no joints            Exact                (machine precision at any step)
///   stiff, linear, few numbers that move Exponential          (exact at any step)
///   a little stiff, many numbers         RungeKutta4 in parts (as many as make each part soft; |h lambda| up to 6.4, or 25.6 if large)
///   stiff otherwise                      Radau5               (rtol 1e-9)
///   stiff and large (200 numbers)        DormandPrince54      (explicit: many short internal steps)
///   forces that jump to and fro          RungeKutta4 over jumps (32 parts or more, without control of the error; Radau5 tries it first)
///   fast spin, no joints                 RotationSplitting 4
///   else                                 RungeKutta4          (the same bits as Solver/RungeKutta4)
///
/// Stiff: |h lambda| > 0.5 and > 4 |w| h for some member, as measured from the slopes of a step of RungeKutta4 (stiffness.h). If the step
/// turns out stiff, it is undone and repeated with another method. So nothing diverges before stiffness is noticed, and groups that are
/// not stiff pay nothing. Fast: h |w| > 0.05.
/// The choice depends only on the state at the start of the advance and on its length. Rewinds, trials and replays therefore choose the
/// same method, groups that share the component do not influence one another, and nothing has to be saved. The output `resolved` names
/// the methods of the last steps, and `reason` states why the last new one was chosen. The event solver.chosen reports each method once,
/// except RungeKutta4 and Exact. What parts do not resolve is continued by DormandPrince54.
///
/// Control of the error ends where forces jump to and fro: a script that pushes back from both sides of a line, as Coulomb's friction and
/// bang-bang controllers do, lets no internal step through that is longer than it takes to cross the line (a sliding mode: Filippov,
/// Differential equations with discontinuous righthand sides). Short equal steps zigzag along the line instead, and follow the sliding
/// motion to their order 1. A force that jumps once in a step is still located. Each advance therefore takes at most 1000 internal steps,
/// or 20,000 if few of them are refused.
///
/// Sources: Hairer, Wanner, Solving ordinary differential equations II, section IV.2 (stiffness detection); the bounds:
/// tests/unit/solvers/automatic_test.cpp.
#pragma once

#include "dormand_prince54.h"
#include "exponential.h"
#include "radau5.h"
#include "reports.h"
#include "stiffness.h"

namespace plab::solvers
{

struct AutomaticMemory
{
    ExponentialMemory exponential;  ///< also used by Radau5
    DormandPrinceMemory dormand;
    ProbeMemory probe;
    std::int64_t before = 0, shown = 0;  ///< methods of the previous step, and those that `resolved` names, as bits
    std::size_t call = 0;                ///< number of calls in this step
};

struct AutomaticRows
{
    Column<std::string> resolved, reason;
    Column<double> spin, stiffness;              ///< h |w|, |h lambda|
    Column<std::int64_t> methods, last_methods;  ///< used since the run began, and in the last step, as bits
    Column<Tick> step;                           ///< the last one
    Column<Integers> soft_turns;                 ///< by call in the last step: 1 if the group was not stiff
    Column<AutomaticMemory> memory;

    void describe(Schema& schema);
};

/// Advances several groups as one system if all of them would choose Exact, or all RungeKutta4; otherwise refuses, with the state of the
/// start.
Result<void> advance_together(const StepContext& context, Row row, AutomaticRows& rows, DynamicSystem& system);

/// One step over context.dt, from coordinates 0.
void advance_automatic(const StepContext& context, Row row, AutomaticRows& rows, DynamicSystem& system);

}  // namespace plab::solvers
