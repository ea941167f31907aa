#include "gravity.h"

namespace plab::fields
{

void GravityRows::describe(Schema& schema)
{
    schema.role(between, "between", {Facet::Body}, "bodies that have weight").writes().independent();
    schema.param(acceleration, "acceleration", unit::metre_per_second2, "of free fall, in the world").or_else({0, 0, -9.81});
}

void apply_gravity(const StepContext& context, Rows rows, const GravityRows& gravity, const Bodies& bodies, Wrenches& wrenches)
{
    for (const Row row : rows)
    {
        wrenches.begin(context.component_of_row[row]);
        for (const Ref body : context.among(gravity.between[row]))
        {
            if (!bodies.dynamic(body.index) || !context.active(body)) continue;
            wrenches.add_force(body, gravity.acceleration[row] * bodies.mass[body.index]);
        }
    }
}

void stored_by_gravity(Rows rows, const GravityRows& gravity, const Bodies& bodies, StoredEnergy& energy)
{
    for (const Row row : rows)
        for (const Ref body : gravity.between[row])
            if (bodies.dynamic(body.index))
                energy.add(-bodies.mass[body.index] * dot(gravity.acceleration[row], bodies.position[body.index]), body);
}

}  // namespace plab::fields
