/// State/User: the hand, or the device, of a person. A body that follows the samples that somebody sends from outside.
///
/// A sample states where the hand is: pose X_WH, its velocity v, w, and how old it is (`sample_age`) at the boundary at which it is set. A
/// sample of age a is extrapolated to the end of the step, T = a + h:
///   p(T) = p + v T,   q(T) = exp(w T) q,   T <= extrapolation,
/// and the body moves there with constant velocity, so that contacts see the velocity with which it really moves:
///   v_WB = (p(T) - p_WB) / h,   w_WB = log(q(T) q_WB^-1) / h,   both within their limits.
/// Without new samples for longer than `extrapolation` it stays where that ends (event user.lost), and after `patience` it counts as gone
/// (user.gone): then it holds nothing any more.
#pragma once

#include "states.h"

namespace plab::bodies
{

struct UserRows
{
    BodyColumns body;
    VelocityColumns velocity;
    // Inputs
    Column<bool> present;
    Column<std::int64_t> sample, buttons;
    Column<double> sample_age, grip;  ///< s; 0 (open) to 1 (closed)
    Column<Vec3> target_position, target_linear_velocity, target_angular_velocity;
    Column<Quat> target_orientation;
    // Parameters
    Column<double> extrapolation, patience;  ///< s
    Column<double> speed_limit, spin_limit;  ///< m/s, rad/s
    // States
    Column<std::int64_t> followed;  ///< the sample that it follows
    Column<double> age;             ///< s, of that sample at the present boundary
    Column<bool> lost, gone;
    // Outputs
    Column<Vec3> force, torque;  ///< N, N m about the origin; on the user, in W
    Column<double> lag;          ///< m

    void describe(Schema& schema);
};

void prepare_user(const StepContext& context, Row row, const UserRows& users, Bodies& bodies, Materials& materials);
/// Phase::Drive: chooses the velocities of the step.
void follow_samples(const StepContext& context, Rows rows, UserRows& users, Bodies& bodies);
/// Phase::Finish: what the user feels.
void feel(const StepContext& context, Rows rows, UserRows& users, const Bodies& bodies, const Touches& touches);

}  // namespace plab::bodies
