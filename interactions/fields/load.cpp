#include "load.h"

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

}  // namespace plab::fields
