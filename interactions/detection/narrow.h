/// The narrow phase: where two shapes at two poses touch, and how deep.
#pragma once

#include "collider.h"
#include "contact_points.h"

namespace plab::detection
{

/// Whether two kinds of shapes collide. Half-spaces and surfaces do not collide with themselves or one another; shapes without
/// volume do not collide at all.
bool meets(ColliderKind a, ColliderKind b);

/// The signed distance. Accurate to rounding while the shapes are separated; for overlapping shapes `gap` is minus a depth that
/// goes to zero with the overlap.
Separation separation(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b);

/// Adds the contact points of `a` at X_a and `b` at X_b. Both poses are relative to a nearby origin, so that distances keep
/// their digits far from the origin of W. The result depends on the arguments only.
void collide(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b, ContactPoints& out);

}  // namespace plab::detection
