/// The mobility of a constraint row, J M^-1 J^T: how an impulse of 1 changes the row's speed.
#pragma once

#include "plab/rotation.h"
#include "plab/rows.h"
#include "plab/tables.h"

namespace plab
{

/// 1/kg or 1/(kg m^2): what the block of a body contributes at its present attitude; 0 for bodies that impulses do not move.
inline double mobility_of(const Bodies& bodies, const RowBlock& block)
{
    const std::uint32_t i = block.participant.index;
    const Vec3 angular_B = rotate_back(bodies.orientation[i], block.angular);
    return length_squared(block.linear) * bodies.inverse_mass[i] + dot(angular_B, bodies.inverse_inertia_B[i] * angular_B);
}

}  // namespace plab
