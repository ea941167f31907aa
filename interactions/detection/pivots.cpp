#include "pivots.h"

#include <cmath>

#include "rim_points.h"

namespace plab::detection
{
namespace
{

Pivot pivot_on_rim(Pivot::Of of, const Solid& cylinder, bool upper, const Vec3& corner)
{
    const double end = upper ? cylinder.size().z : -cylinder.size().z;
    return {.of = of, .kind = Pivot::Arm::OnRim, .arm = corner - (cylinder.pose().p + end * cylinder.axis(2))};
}

Pivot pivot_of_core(Pivot::Of of, const Solid& solid, const Vec3& corner, const Vec3& point)
{
    return {.of = of, .arm = solid.radius() > 0 ? point - corner : Vec3{}};
}

}  // namespace

Pivot pivot_at_corner(Pivot::Of of, const Solid& solid, std::uint32_t number, const Vec3& corner, const Vec3& point)
{
    const bool furthest_on_rim = solid.core() == Core::Cylinder && (number & 7) == RimPoints::kFurthest;
    return furthest_on_rim ? pivot_on_rim(of, solid, number >= 8, corner) : pivot_of_core(of, solid, corner, point);
}

Pivot pivot_at_edge(Pivot::Of of, const Solid& solid, const Vec3& on_edge, const Vec3& point)
{
    if (solid.core() != Core::Cylinder) return pivot_of_core(of, solid, on_edge, point);
    const Vec3 from_middle = on_edge - solid.pose().p, u = solid.axis(2);
    const double along = dot(from_middle, u);
    const bool on_side = std::fabs(along) < solid.size().z;
    return {.of = of, .arm = on_side ? from_middle - along * u : Vec3{}};
}

Pivot pivot_at_end(Pivot::Of of, const Solid& solid, const Vec3& d, const Vec3& corner, const Vec3& point)
{
    if (solid.core() == Core::Cylinder) return pivot_on_rim(of, solid, dot(solid.axis(2), d) > 0, corner);
    return pivot_of_core(of, solid, corner, point);
}

}  // namespace plab::detection
