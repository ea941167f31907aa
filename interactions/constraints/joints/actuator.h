/// Actuator: an effort along the coordinate between a and b (an angle, a travel or a distance; rad or m) that a request, a script or a
/// controller commands.
///
///   u = control within [control_lower, control_upper],   l = gear x,   l' = gear x'
///   F = gain u + bias_0 + bias_1 l + bias_2 l'   within [force_lower, force_upper]
///   effort = gear F                              on b along the coordinate, N m or N; a takes the opposite
///
/// A motor has gain 1 and no bias; a position servo gain kp and bias (0, -kp, -kv); a speed servo gain kv and bias (0, 0, -kv). The law is
/// MuJoCo's for actuators without a state of their own (mujoco.readthedocs.io, "Computation", actuation model). All of its work counts as
/// work: it comes from outside the scene.
#pragma once

#include "joints/motor.h"

namespace plab::constraints
{

struct ActuatorRows : CoordinateRows
{
    Column<double> control, control_lower, control_upper;
    Column<double> gain, gear, force_lower, force_upper;
    Column<Vec3> bias;
    Column<double> effort;
    void describe(Schema& s);
};
Result<void> prepare_actuator(Row row, ActuatorRows& rows, const Bodies& bodies);
void apply_actuator(const StepContext& step, Rows which, const ActuatorRows& rows, const Bodies& bodies, const Shafts& shafts,
                    Wrenches& wrenches);
/// Where the force is at one of its limits, the row starts from the force that the law would give without it, and keeps the limits.
void linearize_actuator(const StepContext& step, Rows which, const ActuatorRows& rows, const Bodies& bodies, const Shafts& shafts,
                        RowSink& sink);
void finish_actuator(const StepContext& step, Rows which, ActuatorRows& rows, const Bodies& bodies, const Shafts& shafts);

}  // namespace plab::constraints
