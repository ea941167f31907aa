#pragma once

#include <array>
#include <vector>

#include "flat_system.h"
#include "reports.h"

namespace plab::solvers
{

/// Solver/DormandPrince54: an explicit Runge-Kutta method of order 5 with an embedded method of order 4. It chooses its own internal
/// steps within the step of the scene, so that the error of each stays below the tolerance.
///
/// - The whole step is tried first, unless an estimate from the first rates (one more evaluation) shows that it is too long; then a
/// proportional-integral controller takes over. An advance depends only on its start, so replays, rewinds and trials of parts of a step
/// get the same numbers.
/// - The last internal step is shortened to end exactly at the end of the step. Dense output would evaluate beyond the end, where scripts
/// and requests may change the equations.
/// - The last stage of an internal step is the first one of the next (FSAL): 6 evaluations per internal step, and one more that books its
/// share in the energy ledger, which has order 5 like the state. Trials do not book and save that evaluation; bookings of a rejected
/// internal step are cancelled.
/// - If max_substeps internal steps do not reach the end, the group stays where the last one ended, with the event solver.gave_up.
/// Sources: Dormand, Prince, J. Comput. Appl. Math. 6 (1980) 19; Hairer, Norsett, Wanner, Solving ordinary differential
/// equations I, sections II.4 and II.5 (coefficients, table 5.2); Gustafsson's controller, part II, section IV.2.
/// Vectors of one advance; memory is kept between steps.
struct DormandPrinceMemory
{
    std::array<std::vector<double>, 7> slope;
    std::vector<double> y, next, error, units, sizes, scale;

    void fit(std::size_t n);
};

using DormandPrinceCounts = SubstepCounts;

struct DormandPrince54Rows : ErrorControlRows
{
    Column<DormandPrinceMemory> memory;

    void describe(Schema& schema);
};

/// The method itself, for solvers that choose it; of a step that is done until `from`, the rest.
DormandPrinceCounts advance_by_dormand_prince(double h, const Tolerance& tolerance, std::int64_t max_substeps, DormandPrinceMemory& memory,
                                              DynamicSystem& system, double from = 0);
/// The event solver.gave_up.
void report_dormand_prince_gave_up(const StepContext& start, Row row, const DormandPrinceCounts& counts);

/// One step over context.dt, from coordinates 0.
void advance_dormand_prince54(const StepContext& context, Row row, DormandPrince54Rows& rows, DynamicSystem& system);

/// Solver/Articulated: DormandPrince54 on the coordinates of the joints.
///
/// Where joints form trees of hinges, sliders, ball joints and welds, the host describes the bodies by the joints' coordinates
/// (sdk/plab/minimal_coordinates.h) and computes accelerations by the articulated body algorithm, in a time proportional to the number of
/// bodies. Joints hold to rounding without multipliers, and the error control sees only motions that the joints allow. Elsewhere (loops,
/// limits, motors, gears) it is DormandPrince54, and an event says why.
/// Source: R. Featherstone, Rigid Body Dynamics Algorithms, Springer 2008, section 7.3.
struct ArticulatedRows : DormandPrince54Rows, ResolvedColumns
{
    void describe(Schema& schema);
};

/// One step over context.dt, from coordinates 0.
void advance_articulated(const StepContext& context, Row row, ArticulatedRows& rows, DynamicSystem& system);

}  // namespace plab::solvers
