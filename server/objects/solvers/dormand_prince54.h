/// Solver/DormandPrince54: explicit Runge-Kutta method of order 5 with an embedded one of order 4, which chooses its own
/// internal steps within the step of the scene, so that the error of each stays below the tolerance.
///
/// - First the whole step is tried at once, unless a guess from the first rates (one more evaluation) says that it is too
///   long; then a proportional-integral controller goes on. An
///   advance depends on nothing but its start: replays, rewinds and trials of parts of a step see the same numbers.
/// - The last internal step is cut to land on the end of the step. Dense output would look beyond the end, where scripts
///   and requests may change the equations.
/// - The last stage of an internal step is the first of the next one (FSAL): 6 evaluations per internal step, and one more
///   that books its share in the energy ledger, which is of order 5 like the state. Trials book nothing and do without;
///   what a refused internal step had booked is taken back.
/// - If max_substeps internal steps do not reach the end, the group stays where it got to, with the event solver.gave_up.
/// Sources: Dormand, Prince, J. Comput. Appl. Math. 6 (1980) 19; Hairer, Norsett, Wanner, Solving ordinary differential
/// equations I, sections II.4 and II.5 (coefficients, table 5.2); Gustafsson's controller, part II, section IV.2.
#pragma once

#include <array>
#include <vector>

#include "error_control.h"
#include "flat_system.h"

namespace plab::solvers
{

/// Vectors of one advance, kept warm.
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

/// The method itself, for solvers that choose it.
DormandPrinceCounts advance_by_dormand_prince(double h, const Tolerance& tolerance, std::int64_t max_substeps, DormandPrinceMemory& memory,
                                              DynamicSystem& system);
/// The event solver.gave_up.
void tell_dormand_prince_gave_up(const StepContext& start, Row row, const DormandPrinceCounts& counts);

/// One step over context.dt, from coordinates 0.
void advance_dormand_prince54(const StepContext& context, Row row, DormandPrince54Rows& rows, DynamicSystem& system);

}  // namespace plab::solvers
