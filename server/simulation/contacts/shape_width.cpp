#include "simulation/contacts/shape_width.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plab::simulation
{

double least_half_width(const Geometry& g)
{
    switch (g.kind)
    {
        case GeometryKind::Sphere:
        case GeometryKind::Capsule:
            return g.size.x;
        case GeometryKind::Box:
            return std::min({g.size.x, g.size.y, g.size.z});
        case GeometryKind::Cylinder:
            return std::min(g.size.x, g.size.z);
        default:
            return 0;
    }
}

double half_width_along(const Geometry& g, const Vec3& d)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    switch (g.kind)
    {
        case GeometryKind::Sphere:
            return g.size.x;
        case GeometryKind::Capsule:
            return g.size.x + std::fabs(d.z) * g.size.z;
        case GeometryKind::Box:
            return std::fabs(d.x) * g.size.x + std::fabs(d.y) * g.size.y + std::fabs(d.z) * g.size.z;
        case GeometryKind::Cylinder:
            return std::hypot(d.x, d.y) * g.size.x + std::fabs(d.z) * g.size.z;
        default:
            break;
    }
    double low = kInfinity, high = -kInfinity;
    for (const Vec3& v : g.vertices) low = std::min(low, dot(v, d)), high = std::max(high, dot(v, d));
    return low <= high ? 0.5 * (high - low) : kInfinity;
}

}  // namespace plab::simulation
