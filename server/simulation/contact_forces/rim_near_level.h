/// The moving point of a cylinder's rim as a contact of springs.
#pragma once

#include "plab/collision.h"

namespace plab::simulation
{

/// Sine of the angle within which a cylinder's end counts as nearly level.
inline constexpr double kNearlyLevel = 1e-3;

/// Moves the contact point that is furthest on a rim (Pivot::Arm::OnRim) towards the middle of the end where that is nearly level.
///
/// The furthest point of a rim jumps to the other side when the end passes through level. Contacts that are held do not mind: fixed points
/// of the rim are as deep there. A spring at it has a potential k d^2 / 2 that is continuous, but a torque that jumps by 2 r k d, so no
/// integrator keeps its order, and none is stable where the cylinder slides upright and trembles about level.
///
/// So the support function of the end, which exceeds that of its middle by r s (radius r, s the sine of the tilt), is replaced by
///   r h(s),   h = s (1 - (1 - t)^3),  t = s / kNearlyLevel < 1,
/// which has h = h' = 0 at level and joins s with two derivatives. The depth is smaller by r (s - h), and the arm of the point from the
/// middle is the derivative of the support function, so the spring stays conservative.
void round_rim_near_level(Contact& contact);

}  // namespace plab::simulation
