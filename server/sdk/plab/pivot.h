/// Pivots (collision.h): where the arm is after a body and the face that it touches have turned; the shape of a hollow face.
#pragma once

#include <cmath>

#include "plab/collision.h"
#include "plab/rotation.h"

namespace plab
{

/// rad, in half a step: what turns further has no middle that says much about the rest.
inline constexpr double kFarthestTurn = 0.05;

/// Whether a hollow face (Hollow::vector() is `bend`) is the inside of a sphere, not of a cylinder.
inline bool is_sphere(const Vec3& bend, const Vec3& normal) { return std::fabs(dot(bend, normal)) > 0.5 * length(bend); }

/// m, W. `towards` (unit, W): from the body to the face, before; `turned`, `turned_face`: how both have turned, in W. The arm of a round
/// end keeps its direction to the face; so does that of a cylinder on its side, which rolls. On a tilted rim, the arm is the radius in the
/// direction of the face.
inline Vec3 turned_arm(const Pivot& pivot, const Vec3& towards, const Quat& turned, const Quat& turned_face)
{
    constexpr double kOnSide = 0x1p-20;  // sine up to which a cylinder counts as lying on its side
    const Vec3 with_face = rotate(turned_face, pivot.arm);
    if (pivot.kind == Pivot::Arm::Constant) return with_face;
    const double radius = length(pivot.arm);
    const Vec3 axis = towards - pivot.arm * (dot(towards, pivot.arm) / (radius * radius));
    const double sine = length(axis);
    if (!(sine > kOnSide)) return with_face;
    const Vec3 u = rotate(turned, axis / sine), d = rotate(turned_face, towards);
    return normalized(d - u * dot(u, d)) * radius;
}

}  // namespace plab
