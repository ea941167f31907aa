#include "built_mesh.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace plab::shapes
{

namespace
{

std::vector<Vec3> lifted(std::span<const Vec3> outline, double z)
{
    std::vector<Vec3> out(outline.begin(), outline.end());
    for (Vec3& v : out) v.z = z;
    return out;
}

/// Points at distance `radius` from the axis, in the directions of the outline's points.
std::vector<Vec3> hole(std::span<const Vec3> outline, double radius, double z)
{
    std::vector<Vec3> out;
    for (const Vec3& v : outline)
    {
        const Vec3 direction = normalized(Vec3{v.x, v.y, 0});
        out.push_back({radius * direction.x, radius * direction.y, z});
    }
    return out;
}

}  // namespace

std::uint32_t BuiltMesh::add_ring(std::span<const Vec3> ring)
{
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), ring.begin(), ring.end());
    return first;
}

std::uint32_t BuiltMesh::add_vertex(const Vec3& v)
{
    vertices.push_back(v);
    return static_cast<std::uint32_t>(vertices.size() - 1);
}

void BuiltMesh::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.insert(triangles.end(), {a, b, c}); }

void BuiltMesh::add_band(std::uint32_t lower, std::uint32_t upper, std::uint32_t count)
{
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const std::uint32_t next = (i + 1) % count;
        add_triangle(lower + i, lower + next, upper + next);
        add_triangle(lower + i, upper + next, upper + i);
    }
}

void BuiltMesh::add_cap(std::uint32_t ring, std::uint32_t count, std::uint32_t tip)
{
    for (std::uint32_t i = 0; i < count; ++i) add_triangle(ring + i, ring + (i + 1) % count, tip);
}

void BuiltMesh::append(const BuiltMesh& other)
{
    const std::uint32_t first = add_ring(other.vertices);
    for (const std::uint32_t v : other.triangles) triangles.push_back(first + v);
}

Geometry BuiltMesh::geometry(const Pose& pose, bool hull_collides) &&
{
    Geometry out;
    out.kind = GeometryKind::Mesh;
    out.pose = pose;
    out.vertices = std::move(vertices);
    out.triangles = std::move(triangles);
    out.hull_collides = hull_collides;
    return out;
}

std::vector<Vec3> circle(double radius, double z, std::uint32_t sides)
{
    std::vector<Vec3> out;
    for (std::uint32_t i = 0; i < sides; ++i)
    {
        const double angle = 2 * std::numbers::pi * i / sides;
        out.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    return out;
}

BuiltMesh turned_profile(std::span<const ProfilePoint> profile, std::uint32_t sides)
{
    BuiltMesh out;
    const std::uint32_t bottom = out.add_vertex({0, 0, profile.front().z});
    std::uint32_t below = 0;
    for (std::size_t i = 1; i + 1 < profile.size(); ++i)
    {
        const std::uint32_t ring = out.add_ring(circle(profile[i].r, profile[i].z, sides));
        if (i > 1) out.add_band(below, ring, sides);
        below = ring;
    }
    const std::uint32_t first = bottom + 1, top = out.add_vertex({0, 0, profile.back().z});
    for (std::uint32_t i = 0; i < sides; ++i) out.add_triangle(first + (i + 1) % sides, first + i, bottom);
    out.add_cap(below, sides, top);
    return out;
}

BuiltMesh bored_prism(std::span<const Vec3> outline, double bore, double half)
{
    BuiltMesh out;
    const auto count = static_cast<std::uint32_t>(outline.size());
    const std::uint32_t bottom = out.add_ring(lifted(outline, -half)), top = out.add_ring(lifted(outline, half));
    out.add_band(bottom, top, count);
    if (bore == 0)
    {
        const std::uint32_t low = out.add_vertex({0, 0, -half}), high = out.add_vertex({0, 0, half});
        out.add_cap(top, count, high);
        for (std::uint32_t i = 0; i < count; ++i) out.add_triangle(bottom + (i + 1) % count, bottom + i, low);
        return out;
    }
    const std::uint32_t hole_bottom = out.add_ring(hole(outline, bore, -half)), hole_top = out.add_ring(hole(outline, bore, half));
    out.add_band(top, hole_top, count);
    out.add_band(hole_top, hole_bottom, count);
    out.add_band(hole_bottom, bottom, count);
    return out;
}

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
