/// Two shapes at two poses: where they touch and how deep.
#pragma once

#include "collider.h"
#include "contact_points.h"

namespace plab::detection
{

/// Half-spaces and surfaces meet neither one another nor themselves; what has no volume meets nobody.
bool meets(ColliderKind a, ColliderKind b);

/// Right to rounding while the shapes are apart; of overlapping ones `gap` is minus a depth that goes to zero with the overlap.
Separation separation(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b);

/// Adds the points where `a` at X_a and `b` at X_b overlap. Both poses are relative to an origin near by, so that
/// distances keep their digits far from the origin of W. The answer depends on nothing but the arguments.
void collide(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b, ContactPoints& out);

}  // namespace plab::detection
