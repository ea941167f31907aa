/// Turning a body by hand, as position corrections do.
#pragma once

#include "plab/tables.h"

namespace plab
{

/// Turns body i by q (W) without work: its spin turns with it. With its angular momentum left behind, a slender body would get a part
/// of that along its thin axis, and L^2 / (2 I) with it.
inline void turn_without_work(Bodies& bodies, std::uint32_t i, const Quat& q)
{
    bodies.orientation[i] = normalized(q * bodies.orientation[i]);
    bodies.angular_momentum[i] = rotate(q, bodies.angular_momentum[i]);
    bodies.angular_velocity[i] = rotate(q, bodies.angular_velocity[i]);
    bodies.refresh_spin(i);
}

}  // namespace plab
