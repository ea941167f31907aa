/// Field/Gravity: F = m g at the centre of mass of each body. g: acceleration, m/s^2, in W.
#pragma once

#include "plab/registrar.h"

namespace plab::fields
{

struct GravityRows
{
    Column<RefList> between;
    Column<Vec3> acceleration;  ///< g_W, m/s^2

    void describe(Schema& schema);
};

void apply_gravity(const StepContext& context, Rows rows, const GravityRows& gravity, const Bodies& bodies, Wrenches& wrenches);

/// V = -sum m g . p_WC, J: zero at the origin of W.
void stored_by_gravity(Rows rows, const GravityRows& gravity, const Bodies& bodies, StoredEnergy& energy);

}  // namespace plab::fields
