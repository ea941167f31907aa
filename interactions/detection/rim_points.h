/// The rims of cylinders, as points.
#pragma once

#include "solid.h"

namespace plab::detection
{

/// Points that represent the rim of one end of a cylinder: four points fixed to the body, and the point furthest in a direction,
/// if there is a unique one.
///
/// The fixed points keep a cylinder upright. Where it leans, the furthest point alone is its rim, and a fixed one that passed it while
/// the cylinder rolls would be a bump. So beyond a slight tilt (sine s of the angle between the end's normal and the direction) they
/// withdraw into the body: their support r s cos(azimuth) is less by r g(s), g = (s - kUpright)^2, and the point at which a force acts is
/// moved such that its moment is the derivative of that (as of any support function), so that springs at them have a potential.
struct RimPoints
{
    static constexpr std::uint32_t kFurthest = 4;
    static constexpr double kUpright = 0.05;  ///< sine of the tilt up to which the fixed points do not withdraw
    std::array<Vec3, 5> p;                    ///< on the rim: where a point is over another surface or not
    std::array<std::uint32_t, 5> id{};
    std::uint32_t count = 0;
    Vec3 withdrawal;  ///< m, of the fixed points
    /// Where the point touches, and a force at it acts.
    Vec3 touching(std::uint32_t i) const { return id[i] == kFurthest ? p[i] : p[i] + withdrawal; }
};
/// `direction`: unit, or zero (then no point is the furthest). Only the furthest point counts of an end that faces away from it.
/// `level_too`: of a level end, which has none, one between two fixed points is taken.
RimPoints rim_points(const Solid& cylinder, bool upper, const Vec3& direction, bool level_too = false);

}  // namespace plab::detection
