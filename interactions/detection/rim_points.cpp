#include "rim_points.h"

#include <cmath>

namespace plab::detection
{
namespace
{

/// m: by how much the fixed points are moved where the end's outward normal u leans from the direction towards `lowest` (unit, in the end).
Vec3 withdrawn(double radius, double sine, double cosine, const Vec3& lowest, const Vec3& u)
{
    const double beyond = sine - RimPoints::kUpright;
    if (!(beyond > 0)) return {};
    const double g = beyond * beyond, slope = 2 * beyond * cosine;  // with respect to the angle
    return -radius * ((g * sine + slope * cosine) * lowest + (g * cosine - slope * sine) * u);
}

}  // namespace

RimPoints rim_points(const Solid& c, bool upper, const Vec3& direction, bool level_too)
{
    RimPoints out;
    const double radius = c.size().x;
    const Vec3 u = upper ? c.axis(2) : -c.axis(2), middle = c.pose().p + c.size().z * u;
    const std::array<Vec3, 4> fixed{c.axis(0), c.axis(1), -c.axis(0), -c.axis(1)};
    const double cosine = dot(u, direction);
    // Of an end that is nearly level this is small, and yet in its plane to the last bit by cross products: the depth depends on that.
    const Vec3 across = std::fabs(cosine) < 0.5 ? direction - cosine * u : cross(cross(u, direction), u);
    const double sine = length(across);
    const bool leans = sine > 1e-12;  // a level end has no furthest point: the choice would depend on rounding and jump from step to step
    if (cosine > 0 || direction == Vec3{})
    {
        if (leans) out.withdrawal = withdrawn(radius, sine, cosine, across / sine, u);
        for (; out.count < 4; ++out.count) out.p[out.count] = middle + radius * fixed[out.count], out.id[out.count] = out.count;
    }
    if (leans)
        out.p[out.count] = middle + (radius / sine) * across, out.id[out.count++] = RimPoints::kFurthest;
    else if (level_too && cosine > 0)
        out.p[out.count] = middle + radius * normalized(c.axis(0) + c.axis(1)), out.id[out.count++] = RimPoints::kFurthest;
    return out;
}

}  // namespace plab::detection
