#include "simulation/contacts/shape_width.h"

#include <algorithm>
#include <cmath>
#include <span>

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

namespace
{

/// Half of the longest chord through a box along a direction.
double through_box(const Vec3& half_extents, const Vec3& d)
{
    const auto through = [](double half, double share) { return share != 0 ? half / std::fabs(share) : HUGE_VAL; };
    return std::min({through(half_extents.x, d.x), through(half_extents.y, d.y), through(half_extents.z, d.z)});
}

Vec3 half_extents_of(std::span<const Vec3> vertices)
{
    Vec3 low = vertices.front(), high = low;
    for (const Vec3& v : vertices)
    {
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    return (high - low) * 0.5;
}

}  // namespace

double half_width_along(const Geometry& g, const Vec3& d)
{
    const double across = std::hypot(d.x, d.y);
    switch (g.kind)
    {
        case GeometryKind::Sphere:
            return g.size.x;
        case GeometryKind::Capsule:
            return std::min(through_box({g.size.x, HUGE_VAL, HUGE_VAL}, {across, 0, 0}), g.size.x + g.size.z);
        case GeometryKind::Box:
            return through_box(g.size, d);
        case GeometryKind::Cylinder:
            return through_box({g.size.x, HUGE_VAL, g.size.z}, {across, 0, d.z});
        default:
            return g.vertices.empty() ? HUGE_VAL : through_box(half_extents_of(g.vertices), d);
    }
}

}  // namespace plab::simulation
