#include "exact_pairs.h"

#include <algorithm>
#include <cmath>

#include "spread.h"

namespace plab::detection
{
namespace
{
/// Upwards, for centres that coincide and so have no direction between them.
constexpr Vec3 kNoDirection{0, 0, 1};

struct Nearest
{
    Vec3 point;
    double distance_squared = 0;
};

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 ab = b - a;
    const double t = std::clamp(dot(p - a, ab) / length_squared(ab), 0.0, 1.0);
    return a + t * ab;
}

/// The point of a triangle nearest to p, which is above its plane: the foot if it is inside, else on an edge.
Vec3 nearest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& corner, const Vec3& normal)
{
    bool inside = true;
    Nearest best{corner[0], length_squared(p - corner[0])};
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Vec3& a = corner[i];
        const Vec3& b = corner[(i + 1) % 3];
        if (dot(cross(normal, b - a), p - a) >= 0) continue;
        inside = false;
        const Vec3 q = nearest_on_segment(p, a, b);
        if (const double d = length_squared(p - q); d < best.distance_squared) best = {q, d};
    }
    return inside ? p - dot(p - corner[0], normal) * normal : best.point;
}

/// A sphere whose centre is `out` m (< 0: inside) from the nearest point of a solid's surface; n points from solid to
/// sphere.
Touch sphere_touch(double radius, const Vec3& nearest, const Vec3& n, double outside)
{
    const double depth = radius - outside;
    return {nearest - n * (0.5 * depth), -n, depth, 0};
}
}  // namespace

void sphere_sphere(double radius_a, const Vec3& a, double radius_b, const Vec3& b, Touches& out)
{
    const Vec3 r = b - a;
    const double distance = length(r);
    const Vec3 n = distance > 0 ? r / distance : kNoDirection;
    const double depth = (radius_a + radius_b) - distance;
    out.add({a + n * (radius_a - 0.5 * depth), n, depth, 0});
}

void sphere_plane(double radius, const Vec3& center, const Pose& X_plane, Touches& out)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1});
    const double outside = dot(n, center - X_plane.p);
    out.add(sphere_touch(radius, center - n * outside, n, outside));
}

void sphere_box(double radius, const Vec3& center, const Vec3& half, const Pose& X_box, Touches& out)
{
    const Vec3 c = rotate_back(X_box.q, center - X_box.p);
    Vec3 nearest, n;
    for (int k = 0; k < 3; ++k) nearest[k] = std::clamp(c[k], -half[k], half[k]);
    double outside = length(c - nearest);
    if (outside > 0)
        n = (c - nearest) / outside;
    else
    {
        int face = 0;
        for (int k = 1; k < 3; ++k)
            if (half[k] - std::fabs(c[k]) < half[face] - std::fabs(c[face])) face = k;
        n[face] = c[face] < 0 ? -1.0 : 1.0;
        nearest[face] = n[face] * half[face];
        outside = std::fabs(c[face]) - half[face];
    }
    out.add(sphere_touch(radius, X_box * nearest, rotate(X_box.q, n), outside));
}

void sphere_hull(double radius, const Vec3& center, const Hull& hull, const Pose& X_hull, Touches& out)
{
    const Vec3 c = rotate_back(X_hull.q, center - X_hull.p);
    std::size_t top = 0;
    double outside = -HUGE_VAL;
    for (std::size_t f = 0; f < hull.faces.size(); ++f)
        if (const double d = dot(hull.normals[f], c) - hull.offsets[f]; d > outside) outside = d, top = f;
    if (outside >= radius) return;
    Vec3 n = hull.normals[top];
    Vec3 nearest = c - n * outside;
    if (outside > 0)
    {
        // The nearest point lies on a face that sees the centre.
        double best = HUGE_VAL;
        for (std::size_t f = 0; f < hull.faces.size(); ++f)
        {
            if (dot(hull.normals[f], c) <= hull.offsets[f]) continue;
            const auto& v = hull.faces[f];
            const Vec3 q = nearest_on_triangle(c, {hull.vertices[v[0]], hull.vertices[v[1]], hull.vertices[v[2]]}, hull.normals[f]);
            if (const double d = length_squared(c - q); d < best) best = d, nearest = q;
        }
        outside = length(c - nearest);
        if (outside > 0) n = (c - nearest) / outside;
    }
    out.add(sphere_touch(radius, X_hull * nearest, rotate(X_hull.q, n), outside));
}

void box_plane(const Vec3& half, const Pose& X_box, const Pose& X_plane, Touches& out)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1});
    for (std::uint32_t i = 0; i < 8; ++i)
    {
        const Vec3 corner = X_box * Vec3{i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z};
        const double depth = -dot(n, corner - X_plane.p);
        out.add({corner + n * (0.5 * depth), -n, depth, i});
    }
}

void hull_plane(const Hull& hull, const Pose& X_hull, const Pose& X_plane, Touches& out)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1});
    Spread spread(n);
    for (std::uint32_t i = 0; i < hull.vertices.size(); ++i)
    {
        const Vec3 p = X_hull * hull.vertices[i];
        const double depth = -dot(n, p - X_plane.p);
        spread.offer({p + n * (0.5 * depth), -n, depth, i % kFeatures});
    }
    spread.take(out);
}

}  // namespace plab::detection
