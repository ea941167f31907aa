/// Constraint/Snap: draws two frames together, critically damped: a pair of constraints, for places and for axes.
///
/// With the error e of frame b in the axes of frame a (m; rad), e' = J v and e'' = J v' + J' v (sides.h), the forces J^T lambda make
///
///   e'' = -w^2 e - 2 w e',  so that  e(t) = (e0 + (e0' + w e0) t) exp(-w t):
///
/// within 1.1 % of e0 after 6.5 / w, without overshoot from rest.
///
///   Acceleration   J v' = bias - w^2 e - 2 w J v with bias = -J' v: rows that ask for an acceleration. They are solved together with the
///                  joints of the two, so it is true whatever else holds them. Their speed is asked to be what it is, so nothing jumps.
///   Force          (J M^-1 J^T) lambda = bias - w^2 e - 2 w J v: true for two bodies that nothing else holds.
///
/// Both sides feel the same force at the same point, so momentum and angular momentum are those of the two before. The work is booked.
///
/// Sources: A. Witkin, M. Gleicher, W. Welch, Interactive dynamics, SIGGRAPH 1990; R. Smith, Dynamics simulation, 2001, on soft
/// constraints.
#pragma once

#include "joints/pair.h"

namespace plab::constraints
{

struct SnapRows
{
    Column<Ref> a, b;
    Column<Vec3> point_a, point_b;  ///< m, in the frames of a (of the world, if there is no a) and of b
    Column<Quat> frame_a, frame_b;
    Column<double> frequency;  ///< Hz
    Column<bool> turns;
    Column<double> distance, angle;  ///< m, rad

    void describe(Schema& s);
};

void constrain_snap(const StepContext& step, Rows which, const SnapRows& rows, const Bodies& bodies, RowSink& sink);
void draw_together(const StepContext& step, Rows which, const SnapRows& rows, const Bodies& bodies, Wrenches& wrenches);
void finish_snap(Rows which, SnapRows& rows, const Bodies& bodies);

}  // namespace plab::constraints
