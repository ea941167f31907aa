/// Solver/Radau5: the implicit Runge-Kutta method of Radau (IIA, 3 stages, order 5), for stiff systems. L-stable: what is
/// too fast for the tolerance to show is damped away. Chooses its own internal steps within the step of the scene.
///
/// - Each internal step solves its three stages by simplified Newton steps, decoupled into one real and one complex linear
///   system of the size of y (Hairer and Wanner's transformation); dense LU, Jacobian by differences.
/// - The error is estimated by an embedded formula of order 3, filtered once more where that is large, and held below
///   0.1 rtol^(2/3), the same in relation to the absolute tolerance; the order 5 of the result then gives about rtol.
/// - First the whole step is tried at once. An advance depends on nothing but its start, so replays, rewinds and trials of
///   parts of a step see the same numbers. A multistep method (CVODE) would lose what it remembers at each step and event,
///   and start with order 1 again.
/// - The energy ledger books the three stages with the weights of the method (order 5), one evaluation each.
/// - Where forces jump, an internal step of 1e-10 of the whole one is made whatever its error: that is how well the time of the
///   jump is known.
/// - Dense: more than 300 numbers in a group are named once by the event solver.large, with what they cost.
/// - If max_substeps internal steps do not reach the end, the group stays where it got to: event solver.gave_up.
/// Source: Hairer, Wanner, Solving ordinary differential equations II, section IV.8; the program RADAU5.
#pragma once

#include <functional>

#include "radau5_stages.h"
#include "reports.h"

namespace plab::solvers
{

struct Radau5Counts : SubstepCounts
{
    std::int64_t factorisations = 0;
};

struct Radau5Rows : ErrorControlRows
{
    Column<std::int64_t> factorisations;
    Column<bool> reported_size;
    Column<Radau5Memory> memory;

    void describe(Schema& schema);
};

/// One step over context.dt, from coordinates 0.
void advance_radau5(const StepContext& context, Row row, Radau5Rows& rows, DynamicSystem& system);

/// Asked after each internal step that was tried, whether to go on. memory.y is the state at counts.reached then.
using GoesOn = std::function<bool(const Radau5Counts& counts)>;
/// The method itself, for solvers that choose it. It has failed if reached < h.
Radau5Counts advance_by_radau(double h, const Tolerance& tolerance, std::int64_t max_substeps, Radau5Memory& memory, DynamicSystem& system,
                              const GoesOn& goes_on = {});
/// The event of an advance that did not reach its end; h in s.
void report_radau_gave_up(const StepContext& start, Row row, const Radau5Counts& counts);

}  // namespace plab::solvers
