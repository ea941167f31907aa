#include "rim_points.h"

namespace plab::detection
{

RimPoints rim_points(const Solid& c, bool upper, const Vec3& direction)
{
    RimPoints out;
    const Vec3 u = c.axis(2), middle = c.pose().p + (upper ? c.size().z : -c.size().z) * u;
    const std::array<Vec3, 4> fixed{c.axis(0), c.axis(1), -c.axis(0), -c.axis(1)};
    for (; out.count < 4; ++out.count) out.p[out.count] = middle + c.size().x * fixed[out.count], out.id[out.count] = out.count;
    // By cross products it is in the plane of the end to the last bit, however small it is: the depth depends on that.
    const Vec3 across = cross(cross(u, direction), u);
    const double sine = length(across);
    // A level end has no furthest point: the choice would depend on rounding and jump from step to step.
    if (sine > 1e-12) out.p[out.count] = middle + (c.size().x / sine) * across, out.id[out.count++] = RimPoints::kFurthest;
    return out;
}

}  // namespace plab::detection
