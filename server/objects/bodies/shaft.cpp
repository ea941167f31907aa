#include "shaft.h"

#include "check_positive.h"

namespace plab::bodies
{

void ShaftRows::describe(Schema& schema)
{
    schema.state(angle, "angle", unit::radian, "angle from its zero position; never wrapped").hosted();
    schema.state(angular_velocity, "angular_velocity", unit::radian_per_second, "about the axis").hosted();
    schema.param(inertia, "inertia", unit::kilogram_metre2, "about the axle; not needed where the speed is prescribed").or_else(0);
    schema.param(position, "position", unit::metre, "a point of the axle, in the world; the shapes' origin").or_else({});
    schema.param(axis, "axis", unit::one, "direction of the axle, in the world").or_else({0, 0, 1}).unit_length();
    schema.param(prescribed, "prescribed", unit::one, "turns at its angular_velocity, whatever torque acts on it").or_else(false);
    describe_color(color, schema);
    schema.role(shape, "shape", {Facet::Shape}, "shape for drawing; its frame has z along the axle").optional();
    describe_solver(solver, schema);
}

Quat rotation_from_z(const Vec3& axis)
{
    // Half-angle formulas with the cosine or the sine, whichever avoids cancellation.
    if (axis.z >= 0)
    {
        const double w = std::sqrt(0.5 * (1 + axis.z));
        return normalized(Quat{w, -axis.y / (2 * w), axis.x / (2 * w), 0});
    }
    const double s = std::sqrt(0.5 * (1 - axis.z));
    const double across = std::sqrt(axis.x * axis.x + axis.y * axis.y);
    if (across == 0) return {0, 1, 0, 0};
    return normalized(Quat{across / (2 * s), -s * axis.y / across, s * axis.x / across, 0});
}

Result<void> prepare_shaft(const StepContext& context, Row row, const ShaftRows& rows, Shafts& shafts)
{
    const double inertia = rows.inertia[row];
    const bool prescribed = rows.prescribed[row];
    const bool left_out = prescribed && inertia == 0;
    if (auto positive = check_positive("inertia", inertia); !positive && !left_out) return positive;

    const std::uint32_t index = context.facet_of_row[row];
    shafts.motion[index] = prescribed ? Motion::Kinematic : Motion::Dynamic;
    shafts.inertia[index] = inertia;
    shafts.inverse_inertia[index] = prescribed ? 0 : 1 / inertia;
    shafts.axle[index] = {rows.position[row], rotation_from_z(rows.axis[row])};
    shafts.shapes[index] = rows.shape[row];
    return {};
}

}  // namespace plab::bodies
