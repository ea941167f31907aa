/// Rotating a body directly, as position corrections do.
#pragma once

#include "plab/tables.h"

namespace plab
{

/// Rotates body i by q (in W) without doing work: its angular momentum is rotated with it. If the momentum kept its direction, a slender
/// body would get part of it along its thin axis, and with it the energy L^2 / (2 I).
inline void turn_without_work(Bodies& bodies, std::uint32_t i, const Quat& q)
{
    bodies.orientation[i] = normalized(q * bodies.orientation[i]);
    bodies.angular_momentum[i] = rotate(q, bodies.angular_momentum[i]);
    bodies.angular_velocity[i] = rotate(q, bodies.angular_velocity[i]);
    bodies.refresh_spin(i);
}

}  // namespace plab
