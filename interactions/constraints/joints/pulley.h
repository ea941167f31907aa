/// A rope over two wheels, whose ends hang from them: what one end gains the other loses.
///
///   C = |p_a - w_a| + ratio |p_b - w_b| - length = 0        the sum of two distance rows; w_a, w_b fixed in the carrier
///
/// The rope has no mass and the wheels turn without friction and inertia, so its tension T is the same everywhere: T on a, ratio T on b. A
/// ratio of n is that of a tackle in which n parts of the rope carry b. A rope that can go slack has C <= 0 and T >= 0: a one-sided row,
/// which a manager solves.
#pragma once

#include "joints/distance.h"

namespace plab::constraints
{

struct PulleyRows
{
    Column<Ref> a, b, carrier, manager;
    Column<Vec3> anchor_a, anchor_b;                                          // m, in the frames of a and b
    Column<Vec3> wheel_a, wheel_b;                                            // m, in W
    Column<Vec3> placed_wheel_a, placed_wheel_b, point_a, point_b;            // m; point_*: of the wheels, in the carrier or in W
    Column<double> ratio, length, placed_length;                              // 1, m, m
    Column<double> length_a, length_b, tension, position_error, speed_error;  // m, m, N, m, m/s
    Column<double> restitution;
    Column<bool> slack;
    Column<std::int64_t> redundant;

    void describe(Schema& s);
};

Result<void> prepare_pulley(Row row, PulleyRows& rows, const Bodies& bodies);
void constrain_pulley(const StepContext& step, Rows which, const PulleyRows& rows, const Bodies& bodies, RowSink& sink);
void finish_pulley(const StepContext& step, Rows which, PulleyRows& rows, const Bodies& bodies, const RowReports& reports);

}  // namespace plab::constraints
