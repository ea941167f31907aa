#include <algorithm>
#include <limits>

#include "frame.h"
#include "matrix.h"
#include "render/render.h"

namespace plab::render
{
namespace
{

/// A little air around everything.
constexpr double kMargin = 1.1;

/// The middle of the box around all balls, and the radius that holds them.
struct Extent
{
    Vec3 middle;
    double radius = 1;
};

Extent extent_of(const std::vector<Item>& items, const std::vector<double>& mesh_radii)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3 low{kInfinity, kInfinity, kInfinity}, high = -low;
    const auto counts = [](const Item& item) { return item.form != Form::Plane && can_be_drawn(item); };
    for (const Item& item : items)
    {
        if (!counts(item)) continue;
        const double radius = radius_of(item, mesh_radii);
        for (int k = 0; k < 3; ++k)
        {
            low[k] = std::min(low[k], item.pose.p[k] - radius);
            high[k] = std::max(high[k], item.pose.p[k] + radius);
        }
    }
    if (!(low.x <= high.x)) return {};
    Extent out{(low + high) * 0.5, 0};
    for (const Item& item : items)
        if (counts(item)) out.radius = std::max(out.radius, length(item.pose.p - out.middle) + radius_of(item, mesh_radii));
    if (!(out.radius > 0)) out.radius = 1;
    return out;
}

View view_of(const Extent& extent, double azimuth, double elevation)
{
    View out;
    out.look_at = extent.middle;
    const Vec3 direction{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
    out.position = extent.middle + direction * (kMargin * extent.radius / std::sin(0.5 * out.field_of_view));
    return out;
}

}  // namespace

View view_of_everything(const Drawing& drawing, double azimuth, double elevation)
{
    std::vector<double> radii;
    for (const Mesh& mesh : drawing.meshes) radii.push_back(radius_of(mesh));
    return view_of(extent_of(drawing.items, radii), azimuth, elevation);
}

View view_of_everything(const std::vector<Item>& items, double azimuth, double elevation)
{
    return view_of(extent_of(items, {}), azimuth, elevation);
}

}  // namespace plab::render
