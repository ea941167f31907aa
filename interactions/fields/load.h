/// Field/Load: a constant force and torque, in W, on bodies; a constant torque on shafts. N, N m.
///
/// F acts at the centre of mass, and M is a torque about it; a shaft takes `shaft_torque` about its axle. A dead load: it does
/// not turn with the body.
#pragma once

#include "plab/registrar.h"

namespace plab::fields
{

struct LoadRows
{
    Column<RefList> between;
    Column<Vec3> force;           ///< F_W, N
    Column<Vec3> torque;          ///< M_W, N m
    Column<double> shaft_torque;  ///< N m

    void describe(Schema& schema);
};

void apply_load(const StepContext& context, Rows rows, const LoadRows& load, const Bodies& bodies, const Shafts& shafts,
                Wrenches& wrenches);

}  // namespace plab::fields
