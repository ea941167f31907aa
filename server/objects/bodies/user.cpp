#include "user.h"

#include <algorithm>

#include "plab/rotation.h"

namespace plab::bodies
{

void UserRows::describe(Schema& schema)
{
    body.describe(schema);
    velocity.describe(schema);
    schema.state(present, "present", unit::one, "somebody sends samples; false: it stands still and holds nothing").input();
    schema.state(sample, "sample", unit::one, "number of the newest sample; another number than before marks a new one").input();
    schema.state(sample_age, "sample_age", unit::second, "age of that sample when it is set").not_negative().input();
    schema.state(target_position, "target_position", unit::metre, "of the sample, in the world").input();
    schema.state(target_orientation, "target_orientation", unit::one, "of the sample; turns the body's axes into the world's").input();
    schema.state(target_linear_velocity, "target_linear_velocity", unit::metre_per_second, "of the sample, in the world").input();
    schema.state(target_angular_velocity, "target_angular_velocity", unit::radian_per_second, "of the sample, in the world").input();
    schema.state(grip, "grip", unit::one, "how far the hand is closed: 0 open, 1 closed").at_least(0).at_most(1).input();
    schema.state(buttons, "buttons", unit::one, "pressed buttons, one bit each").not_negative().input();
    schema.param(extrapolation, "extrapolation", unit::second, "for how long a sample is extrapolated; then it stands still")
        .or_else(0.1)
        .not_negative();
    schema.param(patience, "patience", unit::second, "after how long without a sample the user counts as gone").or_else(1).positive();
    schema.param(speed_limit, "speed_limit", unit::metre_per_second, "largest speed with which it follows").or_else(20).positive();
    schema.param(spin_limit, "spin_limit", unit::radian_per_second, "largest angular speed with which it follows").or_else(100).positive();
    schema.state(followed, "followed", unit::one, "number of the sample that it follows");
    schema.state(age, "age", unit::second, "of that sample");
    schema.state(lost, "lost", unit::one, "no sample has come for longer than extrapolation");
    schema.state(gone, "gone", unit::one, "no sample has come for longer than patience");
    schema.output(force, "force", unit::newton, "on the user in the step: contacts and what it holds; in the world");
    schema.output(torque, "torque", unit::newton_metre, "the same about the body's origin");
    schema.output(lag, "lag", unit::metre, "distance from the extrapolated sample, where a limit holds it back");
}

void prepare_user(const StepContext& context, Row row, const UserRows& users, Bodies& bodies, Materials& materials)
{
    fill_unpushed(context.facet_of_row[row], Motion::Kinematic, row, users.body, bodies, materials);
}

namespace
{

Vec3 limited(const Vec3& v, double most)
{
    const double n = length(v);
    return n > most ? v * (most / n) : v;
}

/// Takes over a new sample, and tells when samples stay away and come back. `ahead`: s, the age at the end of the step.
void note_age(const StepContext& context, Row row, UserRows& users)
{
    if (users.sample[row] != users.followed[row])
    {
        users.followed[row] = users.sample[row], users.age[row] = users.sample_age[row];
        if (users.lost[row]) context.emit(row, "user.found", Severity::Info, "samples come again");
        users.lost[row] = users.gone[row] = false;
    }
    const double ahead = users.age[row] + context.dt;
    if (!users.lost[row] && ahead > users.extrapolation[row] + context.dt)
    {
        users.lost[row] = true;
        context.emit(row, "user.lost", Severity::Info, "no sample has come for too long to extrapolate: it stands still", {users.age[row]});
    }
    if (!users.gone[row] && ahead > users.patience[row] + context.dt)
    {
        users.gone[row] = true;
        context.emit(row, "user.gone", Severity::Info, "no sample has come: it lets go", {users.age[row]});
    }
    users.age[row] = ahead;
}

}  // namespace

void follow_samples(const StepContext& context, Rows rows, UserRows& users, Bodies& bodies)
{
    for (const Row row : rows)
    {
        const std::uint32_t i = context.facet_of_row[row];
        if (bodies.motion[i] != Motion::Kinematic) continue;
        bodies.velocity[i] = bodies.angular_velocity[i] = {};
        users.lag[row] = 0;
        if (!users.present[row] || users.sample[row] == 0) continue;
        note_age(context, row, users);
        const double T = std::min(users.age[row], users.extrapolation[row]);
        const Vec3 to = users.target_position[row] + T * users.target_linear_velocity[row];
        const Quat turned = exp_rotation(T * users.target_angular_velocity[row]) * users.target_orientation[row];
        const Vec3 way = to - bodies.position[i];
        bodies.velocity[i] = limited(way / context.dt, users.speed_limit[row]);
        bodies.angular_velocity[i] = limited(log_rotation(turned * conjugate(bodies.orientation[i])) / context.dt, users.spin_limit[row]);
        users.lag[row] = length(way - context.dt * bodies.velocity[i]);
    }
}

void feel(const StepContext& context, Rows rows, UserRows& users, const Bodies& bodies, const Touches& touches)
{
    for (const Row row : rows)
    {
        const std::uint32_t i = context.facet_of_row[row];
        Vec3 impulse, turn;
        for (const TouchPoint& t : touches.of({Facet::Body, i}))
            impulse += t.impulse, turn += cross(t.point - bodies.position[i], t.impulse) + t.couple;
        users.force[row] = impulse / context.dt, users.torque[row] = turn / context.dt;
    }
}

}  // namespace plab::bodies
