#include "frame.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace plab::render
{
namespace
{

/// Direction to the light: over the left shoulder of a viewer at the default view.
const Vec3 kToLight = normalized(Vec3{-0.42, -0.55, 1.05});
/// Planes and shadows end this many times the distance from the eye to the focus.
constexpr double kPlaneRange = 14;
/// About this many cells of the grid lie between eye and focus.
constexpr double kCells = 5;

/// 1, 2 or 5 times a power of ten: the next one below `x`.
double round_length(double x)
{
    const double decade = std::pow(10, std::floor(std::log10(x)));
    const double leading = x / decade;
    return decade * (leading >= 5 ? 5 : leading >= 2 ? 2 : 1);
}

Result<void> check(const View& view)
{
    if (!is_finite(view.position) || !is_finite(view.look_at) || !is_finite(view.up))
        return reason("the view is not finite; position, look_at and up must be");
    if (!(view.field_of_view > 0 && view.field_of_view < std::numbers::pi))
        return reason("the view's field of view must lie between 0 and pi");
    const double distance = length(view.look_at - view.position);
    if (!(distance > 1e-9 && distance < 1e15)) return reason("the view must look at a point that is not its own position");
    return {};
}

/// Bounds of everything that casts a shadow within the visible range, along the light's axes, relative to the eye.
Box3 casters(const Drawing& drawing, const Frame& frame, const Basis& light, const std::vector<double>& radii)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Box3 out{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (std::size_t i = 0; i < drawing.items.size(); ++i)
    {
        const Item& item = drawing.items[i];
        if (item.form == Form::Plane || !can_be_drawn(item) || length(item.pose.p - frame.focus) > frame.plane_range) continue;
        const Vec3 p = frame.from_eye(item.pose.p);
        const Vec3 along{dot(p, light.right), dot(p, light.up), dot(p, light.back)};
        for (int k = 0; k < 3; ++k)
        {
            out.low[k] = std::min(out.low[k], along[k] - radii[i]);
            out.high[k] = std::max(out.high[k], along[k] + radii[i]);
        }
    }
    return out;
}

void aim_light(Frame& frame, const Drawing& drawing, const std::vector<double>& radii)
{
    frame.to_light = kToLight;
    frame.light = basis_of(kToLight, {0, 1, 0});
    Box3 box = casters(drawing, frame, frame.light, radii);
    frame.shadows = box.low.x <= box.high.x;
    if (!frame.shadows) return;
    // A square with a margin, so that nothing lies on the edge, and with a minimum depth.
    const double most = std::max({box.high.x - box.low.x, box.high.y - box.low.y, 1e-6 * frame.plane_range});
    const Vec3 middle = (box.low + box.high) * 0.5;
    const double half = 0.53 * most;
    frame.casters = {{middle.x - half, middle.y - half, box.low.z - 0.05 * most},
                     {middle.x + half, middle.y + half, box.high.z + 0.05 * most}};
    frame.light_from_E = orthographic(frame.light, frame.casters);
}

}  // namespace

bool can_be_drawn(const Item& item)
{
    return is_finite(item.pose.p) && is_finite(item.pose.q) && is_finite(item.size) && is_finite(item.color);
}

double radius_of(const Mesh& mesh)
{
    double most = 0;
    for (const Vec3& v : mesh.vertices) most = std::fmax(most, length_squared(v));
    return std::sqrt(most);
}

double radius_of(const Item& item, const std::vector<double>& mesh_radii)
{
    switch (item.form)
    {
        case Form::Sphere:
            return item.size.x;
        case Form::Box:
            return length(item.size);
        case Form::Cylinder:
            return length({item.size.x, item.size.z, 0});
        case Form::Capsule:
            return item.size.x + item.size.z;
        case Form::Plane:
            return 0;
        case Form::Mesh:
            break;
    }
    return item.mesh < mesh_radii.size() ? mesh_radii[item.mesh] : 0;
}

Result<Frame> make_frame(const Drawing& drawing, const std::vector<double>& mesh_radii, std::uint32_t width, std::uint32_t height)
{
    const View& view = drawing.view;
    if (auto fine = check(view); !fine) return fine.error();
    Frame out;
    out.eye = view.position;
    out.focus = view.look_at;
    const Vec3 back = view.position - view.look_at;
    const double distance = length(back);
    out.basis = basis_of(back, view.up);
    out.pixels_per_radian = height / (2 * std::tan(0.5 * view.field_of_view));
    out.plane_range = kPlaneRange * distance;
    out.grid = round_length(distance / kCells);

    std::vector<double> radii;
    for (const Item& item : drawing.items) radii.push_back(radius_of(item, mesh_radii));
    double nearest = distance, farthest = 1.5 * out.plane_range;
    for (std::size_t i = 0; i < radii.size(); ++i)
    {
        if (drawing.items[i].form == Form::Plane || !can_be_drawn(drawing.items[i])) continue;
        const double depth = -dot(out.from_eye(drawing.items[i].pose.p), out.basis.back);
        nearest = std::min(nearest, depth - radii[i]);
        farthest = std::max(farthest, depth + radii[i]);
    }
    // The near plane: the ground begins below the eye, so it must not be too far away; a depth buffer of 24 bits is precise
    // enough for this ratio.
    const double near = std::clamp(0.5 * nearest, 2e-3 * distance, 0.02 * distance);
    out.clip_from_E = perspective(out.basis, view.field_of_view, static_cast<double>(width) / height, near, farthest);
    aim_light(out, drawing, radii);
    return out;
}

}  // namespace plab::render
