#include <algorithm>
#include <limits>
#include <optional>

#include "frame.h"
#include "matrix.h"
#include "render/render.h"

namespace plab::render
{
namespace
{

/// A small margin around everything.
constexpr double kMargin = 1.08;

bool counts(const Item& item) { return item.form != Form::Plane && can_be_drawn(item); }

/// The centre of the box around all balls; empty if there are none.
std::optional<Vec3> middle_of(const std::vector<Item>& items, const std::vector<double>& mesh_radii)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3 low{kInfinity, kInfinity, kInfinity}, high = -low;
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
    return (low + high) * 0.5;
}

View view_of(const std::vector<Item>& items, const std::vector<double>& mesh_radii, double azimuth, double elevation)
{
    View out;
    const Vec3 back{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
    out.look_at = middle_of(items, mesh_radii).value_or(Vec3{});
    // Far enough for the ball that protrudes most from the view's pyramid, whose sides are inclined by half its angle: a ball
    // at (x, y) across and z towards the eye is inside if  max(|x|, |y|) cos h + r <= (distance - z) sin h.
    const Basis basis = basis_of(back, out.up);
    const double half = 0.5 * out.field_of_view;
    double distance = 0;
    for (const Item& item : items)
    {
        if (!counts(item)) continue;
        const Vec3 p = item.pose.p - out.look_at;
        const double across = std::max(std::fabs(dot(p, basis.right)), std::fabs(dot(p, basis.up)));
        distance = std::max(distance, dot(p, basis.back) + across / std::tan(half) + radius_of(item, mesh_radii) / std::sin(half));
    }
    out.position = out.look_at + basis.back * (distance > 0 ? kMargin * distance : 5);
    return out;
}

}  // namespace

View view_of_everything(const Drawing& drawing, double azimuth, double elevation)
{
    std::vector<double> radii;
    for (const Mesh& mesh : drawing.meshes) radii.push_back(radius_of(mesh));
    return view_of(drawing.items, radii, azimuth, elevation);
}

View view_of_everything(const std::vector<Item>& items, double azimuth, double elevation) { return view_of(items, {}, azimuth, elevation); }

}  // namespace plab::render
