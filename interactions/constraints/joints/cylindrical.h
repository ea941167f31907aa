/// Joints that leave two motions along one axis, or in one plane: Cylindrical, Screw, Planar. They belong to the family of rigid_joints.h.
///
///   Cylindrical  t1 . d = t2 . d = 0, n_b along n_a        4 rows, free: travel n . d, and the angle about n
///   Screw        the same, x = lead angle / (2 pi) + s     5 rows, free: both together; x: the travel, s: from where it was placed
///   Planar       n . d = 0, n_b along n_a                  3 rows, free: travel along t1 and t2, and the angle about n
///
/// The point of a moves along with b, so that another joint that replaces one of these holds b where it is.
/// A screw gives work back (efficiency 1): friction in its thread is a Constraint/Motor of speed 0 with a max_effort.
#pragma once

#include "joints/pair.h"

namespace plab::constraints
{

struct CylindricalRows : AxisJointRows, MeterColumns, TravelColumns
{
    void describe(Schema& s);
};
struct ScrewRows : CylindricalRows
{
    Column<double> lead;                // m: travel of b along the axis for a turn about it; negative: a left-hand thread
    Column<double> start, placed_lead;  // m: what the travel is ahead of the turns, where the joint was placed; the lead then
    void describe(Schema& s);
};
struct PlanarRows : AxisJointRows, MeterColumns
{
    void describe(Schema& s);
};

// Phase::Prepare.
void prepare_cylindrical(Row row, CylindricalRows& rows, const Bodies& bodies);
void prepare_screw(Row row, ScrewRows& rows, const Bodies& bodies);
void prepare_planar(Row row, PlanarRows& rows, const Bodies& bodies);
// Phase::Constrain.
void constrain_cylindrical(const StepContext& step, Rows which, const CylindricalRows& rows, const Bodies& bodies, RowSink& sink);
void constrain_screw(const StepContext& step, Rows which, const ScrewRows& rows, const Bodies& bodies, RowSink& sink);
void constrain_planar(const StepContext& step, Rows which, const PlanarRows& rows, const Bodies& bodies, RowSink& sink);
// Phase::Finish.
void finish_cylindrical(const StepContext& step, Rows which, CylindricalRows& rows, const Bodies& bodies, const RowReports& reports);
void finish_screw(const StepContext& step, Rows which, ScrewRows& rows, const Bodies& bodies, const RowReports& reports);
void finish_planar(const StepContext& step, Rows which, PlanarRows& rows, const Bodies& bodies, const RowReports& reports);

}  // namespace plab::constraints
