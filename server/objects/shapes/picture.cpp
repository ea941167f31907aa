#include "picture.h"

#include <numbers>

namespace plab::shapes
{
namespace
{
constexpr std::uint32_t kSides = 64;
constexpr int kQuarter = 12;  ///< rings from the equator of a ball to its pole

/// A ball of `radius` that is stretched by a straight part of length 2 `half` along z.
BuiltMesh long_ball(double radius, double half)
{
    std::vector<ProfilePoint> profile{{0, -half - radius}};
    const auto add = [&](int i, double z)
    {
        const double angle = 0.5 * std::numbers::pi * i / kQuarter;
        profile.push_back({radius * std::cos(angle), z + std::copysign(radius, z) * std::sin(angle)});
    };
    for (int i = kQuarter - 1; i > 0; --i) add(i, -half);
    profile.push_back({radius, -half});
    if (half > 0) profile.push_back({radius, half});
    for (int i = 1; i < kQuarter; ++i) add(i, half);
    profile.push_back({0, half + radius});
    return turned_profile(profile, kSides);
}

BuiltMesh block(const Vec3& h)
{
    BuiltMesh out;
    const Vec3 bottom[] = {{-h.x, -h.y, -h.z}, {h.x, -h.y, -h.z}, {h.x, h.y, -h.z}, {-h.x, h.y, -h.z}};
    const Vec3 top[] = {{-h.x, -h.y, h.z}, {h.x, -h.y, h.z}, {h.x, h.y, h.z}, {-h.x, h.y, h.z}};
    const std::uint32_t low = out.add_ring(bottom), high = out.add_ring(top);
    out.add_band(low, high, 4);
    out.add_triangle(low, low + 2, low + 1), out.add_triangle(low, low + 3, low + 2);
    out.add_triangle(high, high + 1, high + 2), out.add_triangle(high, high + 2, high + 3);
    return out;
}

BuiltMesh upright(const Geometry& g)
{
    const ProfilePoint barrel[] = {{0, -g.size.z}, {g.size.x, -g.size.z}, {g.size.x, g.size.z}, {0, g.size.z}};
    switch (g.kind)
    {
        case GeometryKind::Sphere:
            return long_ball(g.size.x, 0);
        case GeometryKind::Capsule:
            return long_ball(g.size.x, g.size.z);
        case GeometryKind::Box:
            return block(g.size);
        case GeometryKind::Cylinder:
            return turned_profile(barrel, kSides);
        case GeometryKind::Mesh:
            return {g.vertices, g.triangles};
        case GeometryKind::None:
        case GeometryKind::Plane:
        case GeometryKind::Compound:
            break;
    }
    return {};
}
}  // namespace

BuiltMesh picture_of(const Geometry& geometry)
{
    BuiltMesh out = upright(geometry);
    for (Vec3& v : out.vertices) v = geometry.pose * v;
    return out;
}

}  // namespace plab::shapes
