/// The rims of cylinders, as points.
#pragma once

#include "solid.h"

namespace plab::detection
{

/// Points that represent the rim of one end of a cylinder: four points fixed to the body, and the point furthest in a direction,
/// if there is a unique one.
struct RimPoints
{
    static constexpr std::uint32_t kFurthest = 4;
    std::array<Vec3, 5> p;
    std::array<std::uint32_t, 5> id{};
    std::uint32_t count = 0;
};
RimPoints rim_points(const Solid& cylinder, bool upper, const Vec3& direction);

}  // namespace plab::detection
