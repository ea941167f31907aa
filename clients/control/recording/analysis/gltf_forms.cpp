#include "control/recording/analysis/gltf_forms.h"

#include <cmath>
#include <numbers>
#include <string_view>

#include "idl/topics.h"

namespace plab::analysis
{
namespace
{

constexpr int kSides = 32, kRings = 12;
constexpr double kPlane = 10;  ///< m, half of its side

/// A point of a profile that turns about z, with its normal.
struct ProfilePoint
{
    double radius, z, normal_radius, normal_z;
};

GltfSurface turned(const std::vector<ProfilePoint>& profile)
{
    GltfSurface out;
    for (const ProfilePoint& p : profile)
        for (int i = 0; i <= kSides; ++i)
        {
            const double a = 2 * std::numbers::pi * (i % kSides) / kSides, c = std::cos(a), s = std::sin(a);
            out.points.push_back({p.radius * c, p.radius * s, p.z});
            out.normals.push_back({p.normal_radius * c, p.normal_radius * s, p.normal_z});
        }
    const auto width = static_cast<std::uint32_t>(kSides + 1);
    for (std::uint32_t ring = 0; ring + 1 < profile.size(); ++ring)
        for (std::uint32_t i = 0; i + 1 < width; ++i)
        {
            // A ring of radius 0 is a point: one of the two triangles has no area there.
            const std::uint32_t a = ring * width + i, b = a + 1, c = a + width, d = c + 1;
            if (profile[ring].radius > 0) out.triangles.insert(out.triangles.end(), {a, b, d});
            if (profile[ring + 1].radius > 0) out.triangles.insert(out.triangles.end(), {a, d, c});
        }
    return out;
}

/// From the lower pole to the upper one; the halves are `half` away from the middle.
GltfSurface capsule(double radius, double half)
{
    std::vector<ProfilePoint> profile;
    for (const double side : {-1.0, 1.0})
        for (int i = 0; i <= kRings; ++i)
        {
            const double part = side < 0 ? double(i) / kRings - 1 : double(i) / kRings, angle = part * std::numbers::pi / 2;
            const bool pole = std::fabs(part) == 1;
            const double c = pole ? 0 : std::cos(angle), s = pole ? side : std::sin(angle);
            profile.push_back({radius * c, radius * s + side * half, c, s});
        }
    return turned(profile);
}

GltfSurface cylinder(double radius, double half)
{
    return turned(
        {{0, -half, 0, -1}, {radius, -half, 0, -1}, {radius, -half, 1, 0}, {radius, half, 1, 0}, {radius, half, 0, 1}, {0, half, 0, 1}});
}

void add_face(GltfSurface& out, const Vec3& center, const Vec3& u, const Vec3& v)
{
    const auto first = static_cast<std::uint32_t>(out.points.size());
    const Vec3 normal = normalized(cross(u, v));
    for (const Vec3& p : {center - u - v, center + u - v, center + u + v, center - u + v})
        out.points.push_back(p), out.normals.push_back(normal);
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) out.triangles.push_back(first + i);
}

GltfSurface box(const Vec3& half)
{
    GltfSurface out;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
        {
            Vec3 n, u, v;
            const int second = (axis + 1) % 3, third = (axis + 2) % 3;
            n[axis] = side * half[axis], u[second] = side * half[second], v[third] = half[third];
            add_face(out, n, u, v);
        }
    return out;
}

GltfSurface faces(const plab_v2_Shape& shape)
{
    GltfSurface out;
    const auto at = [&](std::uint32_t i)
    {
        const plab_v2_Vector& v = shape.vertices._buffer[i];
        return Vec3{v.x, v.y, v.z};
    };
    const std::uint32_t count = shape.vertices._length;
    for (std::uint32_t i = 0; i + 2 < shape.triangles._length; i += 3)
    {
        const std::uint32_t* const t = shape.triangles._buffer + i;
        if (t[0] >= count || t[1] >= count || t[2] >= count) continue;
        const Vec3 normal = normalized(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])));
        if (normal == Vec3{}) continue;  // no area
        for (int k = 0; k < 3; ++k)
        {
            out.triangles.push_back(static_cast<std::uint32_t>(out.points.size()));
            out.points.push_back(at(t[k])), out.normals.push_back(normal);
        }
    }
    return out;
}

}  // namespace

GltfSurface surface_of(const plab_v2_Shape& shape)
{
    const std::string_view form = shape.form;
    const Vec3 size{shape.size.x, shape.size.y, shape.size.z};
    if (form == "sphere") return capsule(size.x, 0);
    if (form == "capsule") return capsule(size.x, size.z);
    if (form == "cylinder") return cylinder(size.x, size.z);
    if (form == "box") return box(size);
    GltfSurface out;
    if (form == "plane") return add_face(out, {}, {kPlane, 0, 0}, {0, kPlane, 0}), out;
    return faces(shape);
}

}  // namespace plab::analysis
