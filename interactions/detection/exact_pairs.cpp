#include "exact_pairs.h"

#include <algorithm>
#include <cmath>

#include "pivots.h"
#include "rim_points.h"
#include "spread.h"

namespace plab::detection
{
namespace
{
/// Fallback direction, upwards, for coincident centres.
constexpr Vec3 kNoNormal{0, 0, 1};

/// A sphere whose centre is at the distance `outside` (m, < 0: inside) from the nearest point of a solid's surface; n points from
/// the solid to the sphere.
ContactPoint sphere_contact_point(double radius, const Vec3& nearest, const Vec3& n, double outside, bool on_face)
{
    const double depth = radius - outside;
    const Pivot pivot{.of = Pivot::Of::A, .arm = n * -(outside + 0.5 * depth)};
    return {nearest - n * (0.5 * depth), -n, depth, 0, on_face ? pivot : Pivot{}};
}
}  // namespace

void sphere_sphere(double radius_a, const Vec3& a, double radius_b, const Vec3& b, ContactPoints& out)
{
    const Vec3 r = b - a;
    const double distance = length(r);
    const Vec3 n = distance > 0 ? r / distance : kNoNormal;
    const double depth = (radius_a + radius_b) - distance;
    out.add({a + n * (radius_a - 0.5 * depth), n, depth, 0});
}

void sphere_plane(double radius, const Vec3& center, const Pose& X_plane, ContactPoints& out)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1});
    const double outside = dot(n, center - X_plane.p);
    out.add(sphere_contact_point(radius, center - n * outside, n, outside, true));
}

void sphere_box(double radius, const Vec3& center, const Vec3& half, const Pose& X_box, ContactPoints& out)
{
    const Vec3 c = rotate_back(X_box.q, center - X_box.p);
    Vec3 nearest, n;
    int beyond = 0;  // of how many pairs of faces
    for (int k = 0; k < 3; ++k) nearest[k] = std::clamp(c[k], -half[k], half[k]), beyond += nearest[k] != c[k] ? 1 : 0;
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
    out.add(sphere_contact_point(radius, X_box * nearest, rotate(X_box.q, n), outside, beyond < 2));
}

void box_plane(const Vec3& half, const Pose& X_box, const Pose& X_plane, ContactPoints& out)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1});
    for (std::uint32_t i = 0; i < 8; ++i)
    {
        const Vec3 corner = X_box * Vec3{i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z};
        const double depth = -dot(n, corner - X_plane.p);
        out.add({corner + n * (0.5 * depth), -n, depth, i, Pivot{Pivot::Of::A}});
    }
}

void hull_plane(const Hull& hull, const Pose& X_hull, const Pose& X_plane, ContactPoints& out)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1});
    Spread spread(n, out.margin());
    for (std::uint32_t i = 0; i < hull.vertices.size(); ++i)
    {
        const Vec3 p = X_hull * hull.vertices[i];
        const double depth = -dot(n, p - X_plane.p);
        spread.offer({p + n * (0.5 * depth), -n, depth, i % kFeatures, Pivot{Pivot::Of::A}});
    }
    spread.take(out);
}

void capsule_plane(const Solid& capsule, const Pose& X_plane, ContactPoints& out)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1}), u = capsule.axis(2);
    for (std::uint32_t i = 0; i < 2; ++i)
    {
        const Vec3 end = capsule.pose().p + (i == 0 ? -capsule.size().z : capsule.size().z) * u;
        const double depth = capsule.radius() - dot(n, end - X_plane.p);
        const Vec3 point = end - n * (capsule.radius() - 0.5 * depth);
        out.add({point, -n, depth, i, pivot_at_corner(Pivot::Of::A, capsule, i, end, point)});
    }
}

void cylinder_plane(const Solid& cylinder, const Pose& X_plane, ContactPoints& out)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1});
    const auto offer = [&](const Vec3& p, std::uint32_t feature)
    {
        const double depth = -dot(n, p - X_plane.p);
        const Vec3 point = p + n * (0.5 * depth);
        out.add({point, -n, depth, feature, pivot_at_corner(Pivot::Of::A, cylinder, feature, p, point)});
    };
    for (std::uint32_t end = 0; end < 2; ++end)
    {
        const RimPoints rim = rim_points(cylinder, end == 1, -n, out.level_rims());
        for (std::uint32_t i = 0; i < rim.count; ++i) offer(rim.touching(i), 8 * end + rim.id[i]);
    }
}

}  // namespace plab::detection
