/// Solver/Articulated: DormandPrince54 on the coordinates of the joints.
///
/// Where joints form trees of hinges, sliders, ball joints and welds, the host describes the bodies by the joints' coordinates
/// (sdk/plab/minimal_coordinates.h) and computes accelerations by the articulated body algorithm, in a time proportional to the number of
/// bodies. Joints hold to rounding without multipliers, and the error control sees only motions that the joints allow. Elsewhere (loops,
/// limits, motors, gears) it is DormandPrince54, and an event says why.
/// Source: R. Featherstone, Rigid Body Dynamics Algorithms, Springer 2008, section 7.3.
#pragma once

#include "dormand_prince54.h"
#include "resolved.h"

namespace plab::solvers
{

struct ArticulatedRows : DormandPrince54Rows, ResolvedColumns
{
    void describe(Schema& schema);
};

/// One step over context.dt, from coordinates 0.
void advance_articulated(const StepContext& context, Row row, ArticulatedRows& rows, DynamicSystem& system);

}  // namespace plab::solvers
