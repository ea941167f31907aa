#include "solid.h"

#include <algorithm>
#include <cmath>

namespace plab::detection
{
namespace
{
/// The projection onto the plane perpendicular to n.
Mat3 across(const Vec3& n) { return Mat3::identity() - outer(n, n); }

ClosestPoint closest_point_on_edge(const Vec3& q, const Vec3& a, const Vec3& b)
{
    const Vec3 e = b - a;
    const double along = dot(q - a, e), all = length_squared(e);
    if (!(along > 0)) return {a, {}, 0, {}};
    if (!(along < all)) return {b, {}, 0, {}};
    const Vec3 u = e / std::sqrt(all);
    return {a + (along / all) * e, outer(u, u), 1, u};
}
}  // namespace

Solid::Solid(const Collider& collider, const Pose& X) : size_(collider.size()), X_(X), R_(rotation_matrix(X.q))
{
    center_ = X.p;
    switch (collider.kind())
    {
        case ColliderKind::Sphere:
            radius_ = size_.x;
            break;
        case ColliderKind::Capsule:
            core_ = Core::Segment, radius_ = size_.x, extent_ = size_.z;
            break;
        case ColliderKind::Box:
            core_ = Core::Box, extent_ = length(size_);
            break;
        case ColliderKind::Cylinder:
            core_ = Core::Cylinder, extent_ = std::hypot(size_.x, size_.z);
            break;
        case ColliderKind::Hull:
            core_ = Core::Hull, hull_ = &collider.hull(), center_ = X * hull_->center;
            extent_ = hull_->extent;
            break;
        case ColliderKind::None:
        case ColliderKind::Plane:
        case ColliderKind::Bowl:
        case ColliderKind::Bore:
        case ColliderKind::Triangles:
            break;
    }
}

Solid Solid::rod(const Vec3& a, const Vec3& b)
{
    Solid out;
    const double size = length(b - a);
    const Vec3 u = (b - a) / size, v = any_perpendicular(u), w = cross(u, v);
    for (int i = 0; i < 3; ++i) out.R_(i, 0) = v[i], out.R_(i, 1) = w[i], out.R_(i, 2) = u[i];
    out.core_ = Core::Segment, out.size_ = {0, 0, 0.5 * size}, out.extent_ = 0.5 * size;
    out.X_.p = out.center_ = (a + b) * 0.5;
    return out;
}

Vec3 Solid::support(const Vec3& d) const
{
    if (core_ == Core::Point) return X_.p;
    const Vec3 d_S = to_local_direction(d);
    Vec3 p;
    switch (core_)
    {
        case Core::Segment:
            p.z = d_S.z < 0 ? -size_.z : size_.z;
            break;
        case Core::Box:
            p = {d_S.x < 0 ? -size_.x : size_.x, d_S.y < 0 ? -size_.y : size_.y, d_S.z < 0 ? -size_.z : size_.z};
            break;
        case Core::Cylinder:
        {
            const double across = std::sqrt(d_S.x * d_S.x + d_S.y * d_S.y);
            const double share = across > 0 ? size_.x / across : 0;
            p = {share * d_S.x, share * d_S.y, d_S.z < 0 ? -size_.z : size_.z};
            break;
        }
        case Core::Hull:
            p = hull_->vertices[hull_->vertex_columns.furthest(d_S).index];
            break;
        case Core::Point:
            break;
    }
    return from_local(p);
}

ClosestPoint Solid::closest_point(const Vec3& q, const Facelet& facelet) const
{
    switch (core_)
    {
        case Core::Segment:
            return closest_point_on_segment(q);
        case Core::Box:
            return closest_point_on_box(q);
        case Core::Cylinder:
            return closest_point_on_cylinder(q);
        case Core::Hull:
            return closest_point_on_facelet(q, facelet);
        case Core::Point:
            break;
    }
    return {X_.p, {}, 0, {}};
}

ClosestPoint Solid::closest_point_on_segment(const Vec3& q) const
{
    const Vec3 u = axis(2);
    const double along = dot(u, q - X_.p);
    if (std::fabs(along) >= size_.z) return {X_.p + std::copysign(size_.z, along) * u, {}, 0, {}};
    return {X_.p + along * u, outer(u, u), 1, u};
}

ClosestPoint Solid::closest_point_on_box(const Vec3& q) const
{
    const Vec3 l = to_local(q);
    Vec3 p;
    int flat = 0, clamped = 0, open = 0;
    for (int k = 0; k < 3; ++k)
    {
        p[k] = std::clamp(l[k], -size_[k], size_[k]);
        if (std::fabs(l[k]) >= size_[k])
            clamped = k;
        else
            ++flat, open = k;
    }
    ClosestPoint out{from_local(p), {}, flat, {}};
    if (flat == 1) out.axis = axis(open), out.J = outer(out.axis, out.axis);
    if (flat == 2) out.axis = axis(clamped) * (l[clamped] < 0 ? -1.0 : 1.0), out.J = across(out.axis);
    if (flat == 3) out.J = Mat3::identity();
    return out;
}

ClosestPoint Solid::closest_point_on_cylinder(const Vec3& q) const
{
    const Vec3 l = to_local(q);
    const double rho = std::sqrt(l.x * l.x + l.y * l.y);
    const bool beyond_end = std::fabs(l.z) >= size_.z, beyond_side = rho >= size_.x;
    const Vec3 radial = rho > 0 ? Vec3{l.x / rho, l.y / rho, 0} : Vec3{1, 0, 0}, around{-radial.y, radial.x, 0};
    const double z = beyond_end ? std::copysign(size_.z, l.z) : l.z;
    const Vec3 p = beyond_side ? Vec3{size_.x * radial.x, size_.x * radial.y, z} : Vec3{l.x, l.y, z};
    ClosestPoint out{from_local(p), Mat3::identity(), 3, {}};
    if (beyond_side)
    {
        const Vec3 tangent = from_local_direction(around);
        out.J = outer(tangent, tangent) * (size_.x / rho);
        if (beyond_end)
            out.flat = 1, out.axis = tangent;
        else
            out.flat = 2, out.axis = from_local_direction(radial), out.J = out.J + outer(axis(2), axis(2));
    }
    else if (beyond_end)
        out.flat = 2, out.axis = axis(2) * (l.z < 0 ? -1.0 : 1.0), out.J = across(out.axis);
    return out;
}

ClosestPoint closest_point_on_facelet(const Vec3& q, const Facelet& f)
{
    if (f.count == 1) return {f.corner[0], {}, 0, {}};
    if (f.count == 2) return closest_point_on_edge(q, f.corner[0], f.corner[1]);
    const Vec3 e1 = f.corner[1] - f.corner[0], e2 = f.corner[2] - f.corner[0];
    Vec3 n = cross(e1, e2);
    const double area = length(n);
    if (area > 1e-13 * (length_squared(e1) + length_squared(e2)))
    {
        n = n / area;
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) inside = inside && dot(cross(n, f.corner[(i + 1) % 3] - f.corner[i]), q - f.corner[i]) > 0;
        const double above = dot(n, q - f.corner[0]);
        if (inside) return {q - above * n, Mat3::identity() - outer(n, n), 2, above < 0 ? -n : n};
    }
    ClosestPoint best = closest_point_on_edge(q, f.corner[0], f.corner[1]);
    for (std::size_t i = 1; i < 3; ++i)
        if (const ClosestPoint other = closest_point_on_edge(q, f.corner[i], f.corner[(i + 1) % 3]);
            length_squared(other.p - q) < length_squared(best.p - q))
            best = other;
    return best;
}

}  // namespace plab::detection
