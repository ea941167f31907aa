#include "loads.h"

namespace plab::fields
{

void LoadRows::describe(Schema& schema)
{
    schema.role(between, "between", {Facet::Body, Facet::Shaft}, "bodies and shafts that are loaded, each with the full load")
        .writes()
        .independent();
    schema.param(force, "force", unit::newton, "on each body, in the world, at its centre of mass").or_else({});
    schema.param(torque, "torque", unit::newton_metre, "on each body, in the world").or_else({});
    schema.param(shaft_torque, "shaft_torque", unit::newton_metre, "on each shaft about its axle").or_else(0);
}

void apply_load(const StepContext& context, Rows rows, const LoadRows& load, const Bodies& bodies, const Shafts& shafts, Wrenches& wrenches)
{
    for (const Row row : rows)
    {
        wrenches.begin(context.component_of_row[row]);
        for (const Ref part : load.between[row])
        {
            if (!context.active(part)) continue;
            if (part.facet == Facet::Shaft)
            {
                if (shafts.dynamic(part.index)) wrenches.add_shaft_torque(part, load.shaft_torque[row]);
                continue;
            }
            if (!bodies.dynamic(part.index)) continue;
            wrenches.add_force(part, load.force[row]);
            wrenches.add_torque(part, load.torque[row]);
        }
    }
}

namespace
{

/// -(c1 + c2 |v|) v.
Vec3 resistance(double linear, double quadratic, const Vec3& v) { return v * -(linear + quadratic * length(v)); }

}  // namespace

void DragRows::describe(Schema& schema)
{
    schema.role(between, "between", {Facet::Body, Facet::Shaft}, "bodies and shafts in the medium").writes().independent();
    schema.param(linear, "linear", unit::kilogram_per_second, "force per speed").or_else(0).not_negative();
    schema.param(quadratic, "quadratic", unit::kilogram_per_metre, "force per speed squared").or_else(0).not_negative();
    schema.param(rotational, "rotational", unit::newton_metre_second_per_radian, "torque per angular speed").or_else(0).not_negative();
    schema.param(rotational_quadratic, "rotational_quadratic", unit::newton_metre_second2_per_radian2, "torque per angular speed squared")
        .or_else(0)
        .not_negative();
    schema.param(medium_velocity, "medium_velocity", unit::metre_per_second, "wind, in the world").or_else({});
}

void apply_drag(const StepContext& context, Rows rows, const DragRows& drag, const Bodies& bodies, const Shafts& shafts, Wrenches& wrenches)
{
    for (const Row row : rows)
    {
        wrenches.begin(context.component_of_row[row]);
        const double d1 = drag.rotational[row], d2 = drag.rotational_quadratic[row];
        for (const Ref part : context.among(drag.between[row]))
        {
            if (!context.active(part)) continue;
            const std::uint32_t i = part.index;
            if (part.facet == Facet::Shaft)
            {
                const double speed = shafts.speed[i];
                if (shafts.dynamic(i)) wrenches.add_shaft_torque(part, -(d1 + d2 * std::fabs(speed)) * speed);
                continue;
            }
            if (!bodies.dynamic(i)) continue;
            const Vec3 relative = bodies.velocity[i] - drag.medium_velocity[row];
            wrenches.add_force(part, resistance(drag.linear[row], drag.quadratic[row], relative));
            wrenches.add_torque(part, resistance(d1, d2, bodies.angular_velocity[i]));
        }
    }
}

}  // namespace plab::fields
