#include "volume_integration.h"

#include <algorithm>
#include <numbers>
#include <tuple>
#include <vector>

namespace plab::shapes
{

namespace
{

/// One side of a triangle; forward: it runs from the lower to the higher vertex number.
struct Side
{
    std::uint32_t low, high;
    bool forward;
};

/// The sides of all triangles with three different corners, sorted so that equal edges are adjacent.
std::vector<Side> sorted_sides(std::span<const std::uint32_t> triangles)
{
    std::vector<Side> sides;
    sides.reserve(triangles.size());
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
    {
        const std::uint32_t corner[] = {triangles[i], triangles[i + 1], triangles[i + 2]};
        // Two corners at the same vertex: the triangle is a line whose two sides cancel.
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        for (int k = 0; k < 3; ++k)
        {
            const std::uint32_t from = corner[k], to = corner[(k + 1) % 3];
            sides.push_back({std::min(from, to), std::max(from, to), from < to});
        }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return std::tie(a.low, a.high, a.forward) < std::tie(b.low, b.high, b.forward); });
    return sides;
}

std::string name_of_edge(const Side& side) { return std::to_string(side.low) + "-" + std::to_string(side.high); }

/// `uses`: all sides along one edge.
Result<void> check_edge(std::span<const Side> uses)
{
    if (uses.size() == 2 && uses[0].forward != uses[1].forward) return {};
    const std::string edge = name_of_edge(uses.front());
    if (uses.size() == 1) return reason("mesh is open at edge " + edge + "; every edge must have two triangles");
    if (uses.size() > 2)
        return reason("mesh is not a manifold: edge " + edge + " has " + std::to_string(uses.size()) +
                      " triangles; every edge must have two");
    return reason("mesh is wound inconsistently: the two triangles at edge " + edge + " run along it in the same direction");
}

Result<void> check_edges(std::span<const std::uint32_t> triangles)
{
    const std::vector<Side> sides = sorted_sides(triangles);
    if (sides.empty()) return reason("mesh has no volume; it must enclose a solid");
    for (std::size_t begin = 0; begin < sides.size();)
    {
        std::size_t end = begin + 1;
        while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
        if (auto edge = check_edge(std::span(sides).subspan(begin, end - begin)); !edge) return edge;
        begin = end;
    }
    return {};
}

/// The triangles with each vertex replaced by the first one at the same position.
std::vector<std::uint32_t> welded(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles)
{
    std::vector<std::uint32_t> order(vertices.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto place = [&](std::uint32_t i) { return std::tuple(vertices[i].x, vertices[i].y, vertices[i].z); };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return place(a) != place(b) ? place(a) < place(b) : a < b; });

    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] = k > 0 && place(order[k]) == place(order[k - 1]) ? first[order[k - 1]] : order[k];

    std::vector<std::uint32_t> out(triangles.begin(), triangles.end());
    for (std::uint32_t& v : out) v = first[v];
    return out;
}

}  // namespace

Result<void> check_closed(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles)
{
    if (check_edges(triangles)) return {};
    return check_edges(welded(vertices, triangles));
}

namespace
{

/// If the volume relative to the extent is below this, it is not meaningful because of rounding errors.
constexpr double kFlat = 1e-12;

struct Moments
{
    double volume = 0;  ///< m^3
    Vec3 first;         ///< integral of x, m^4
    Mat3 second;        ///< integral of x x^T, m^5
    double area = 0;    ///< m^2
};

Vec3 mean_of(std::span<const Vec3> vertices)
{
    Vec3 sum;
    for (const Vec3& v : vertices) sum += v;
    return sum / static_cast<double>(vertices.size());
}

double extent_of(std::span<const Vec3> vertices, const Vec3& origin)
{
    double most = 0;
    for (const Vec3& v : vertices) most = std::fmax(most, length(v - origin));
    return most;
}

/// Sums over the tetrahedra (o, a, b, c) of origin and triangle, signed (Tonon 2004; equal to Mirtich 1996):
///   V = det(a, b, c)/6,   int x = V (a + b + c)/4,
///   int x x^T = V/20 (s s^T + a a^T + b b^T + c c^T),  s = a + b + c,  all from o.
Moments moments_about(const Vec3& origin, std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles)
{
    Moments sum;
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
    {
        const Vec3 a = vertices[triangles[i]] - origin;
        const Vec3 b = vertices[triangles[i + 1]] - origin;
        const Vec3 c = vertices[triangles[i + 2]] - origin;
        const Vec3 s = a + b + c;
        const double volume = dot(a, cross(b, c)) / 6;
        sum.volume += volume;
        sum.first += s * (volume / 4);
        sum.second = sum.second + (outer(s, s) + outer(a, a) + outer(b, b) + outer(c, c)) * (volume / 20);
        sum.area += length(cross(b - a, c - a)) / 2;
    }
    return sum;
}

/// tr(M) 1 - M: inertia from the second moments.
Mat3 inertia_of(const Mat3& second)
{
    const double trace = second(0, 0) + second(1, 1) + second(2, 2);
    return Mat3::diagonal(trace, trace, trace) - second;
}

Mat3 symmetric_part(const Mat3& a) { return (a + transposed(a)) * 0.5; }

}  // namespace

MassProperties solid_sphere(double radius)
{
    const double mass = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
    const double inertia = 0.4 * mass * radius * radius;
    return {mass, {}, Mat3::diagonal(inertia, inertia, inertia)};
}

MassProperties solid_box(const Vec3& half_extents)
{
    const double mass = 8 * half_extents.x * half_extents.y * half_extents.z;
    const double xx = half_extents.x * half_extents.x;
    const double yy = half_extents.y * half_extents.y;
    const double zz = half_extents.z * half_extents.z;
    const double third = mass / 3;
    return {mass, {}, Mat3::diagonal(third * (yy + zz), third * (zz + xx), third * (xx + yy))};
}

MassProperties solid_cylinder(double radius, double height)
{
    const double mass = std::numbers::pi * radius * radius * height;
    const double across = mass * (3 * radius * radius + height * height) / 12;
    return {mass, {}, Mat3::diagonal(across, across, 0.5 * mass * radius * radius)};
}

MassProperties solid_capsule(double radius, double length)
{
    const double rr = radius * radius;
    const double barrel = std::numbers::pi * rr * length, ball = 4.0 / 3 * std::numbers::pi * rr * radius;
    const double along = 0.5 * barrel * rr + 0.4 * ball * rr;
    const double across = barrel * (3 * rr + length * length) / 12 + ball * (0.4 * rr + 0.25 * length * length + 0.375 * length * radius);
    return {barrel + ball, {}, Mat3::diagonal(across, across, along)};
}

MassProperties joined(std::span<const MassProperties> parts)
{
    MassProperties out;
    if (parts.empty()) return out;
    // Relative to the first centre, so that differences keep their digits far from the origin.
    const Vec3 origin = parts.front().center;
    Vec3 first;
    for (const MassProperties& p : parts) out.mass += p.mass, first += p.mass * (p.center - origin);
    out.center = origin + first / out.mass;
    for (const MassProperties& p : parts)
    {
        const Vec3 d = (p.center - origin) - first / out.mass;
        const double dd = length_squared(d);
        out.inertia = out.inertia + p.inertia + (Mat3::diagonal(dd, dd, dd) - outer(d, d)) * p.mass;
    }
    return out;
}

Result<MassProperties> solid_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles)
{
    if (auto closed = check_closed(vertices, triangles); !closed) return closed.error();

    // First relative to the mesh's own mean point, then to its centre of mass. The remaining differences are small and keep their digits,
    // even far from the origin or with vertices concentrated at one end.
    const Vec3 mean = mean_of(vertices);
    const Moments rough = moments_about(mean, vertices, triangles);
    if (std::fabs(rough.volume) <= kFlat * rough.area * extent_of(vertices, mean))
        return reason("mesh has no volume; it must enclose a solid");
    if (rough.volume < 0) return reason("mesh is inside out; triangles must be counter-clockwise seen from outside");

    const Vec3 center = mean + rough.first / rough.volume;
    const Moments fine = moments_about(center, vertices, triangles);
    return MassProperties{fine.volume, center, inertia_of(fine.second)};
}

Result<void> measure_mesh_in_body(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles, const Pose& X_BS,
                                  MassProperties& solid)
{
    const auto solid_S = solid_mesh(vertices, triangles);
    if (!solid_S) return solid_S.error();
    solid = posed(*solid_S, X_BS);
    return {};
}

MassProperties posed(const MassProperties& solid_S, const Pose& X_BS)
{
    const Mat3 R = rotation_matrix(X_BS.q);
    return {solid_S.mass, X_BS * solid_S.center, symmetric_part(R * solid_S.inertia * transposed(R))};
}

}  // namespace plab::shapes
