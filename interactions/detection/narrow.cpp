#include "narrow.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "exact_pairs.h"
#include "manifold.h"
#include "pivots.h"
#include "separation.h"
#include "surface_contacts.h"

namespace plab::detection
{
namespace
{
/// Pairs are computed in this order, whatever order they are passed in, so that the result for (b, a) is the exact mirror image
/// of that for (a, b): by kind (planes and surfaces last), then by size and pose.
bool in_order(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b)
{
    const auto rank = [](const Collider& c)
    { return c.kind() == ColliderKind::Plane || is_surface(c.kind()) ? 100 : static_cast<int>(c.kind()); };
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    // Mostly the first numbers differ already.
    const auto order = [](const Vec3& x, const Vec3& y) { return x.x != y.x ? x.x < y.x : x.y != y.y ? x.y < y.y : x.z < y.z; };
    if (a.size() != b.size()) return order(a.size(), b.size());
    if (a.hull().vertices.size() != b.hull().vertices.size()) return a.hull().vertices.size() < b.hull().vertices.size();
    if (X_a.p != X_b.p) return order(X_a.p, X_b.p);
    return std::tie(X_a.q.w, X_a.q.x, X_a.q.y, X_a.q.z) <= std::tie(X_b.q.w, X_b.q.x, X_b.q.y, X_b.q.z);
}

void collide_with_plane(const Collider& a, const Pose& X_a, const Pose& X_plane, ContactPoints& out)
{
    switch (a.kind())
    {
        case ColliderKind::Sphere:
            return sphere_plane(a.size().x, X_a.p, X_plane, out);
        case ColliderKind::Box:
            return box_plane(a.size(), X_a, X_plane, out);
        case ColliderKind::Hull:
            return hull_plane(a.hull(), X_a, X_plane, out);
        case ColliderKind::Capsule:
            return capsule_plane(Solid(a, X_a), X_plane, out);
        case ColliderKind::Cylinder:
            return cylinder_plane(Solid(a, X_a), X_plane, out);
        case ColliderKind::None:
        case ColliderKind::Plane:
        case ColliderKind::Bowl:
        case ColliderKind::Bore:
        case ColliderKind::Triangles:
            break;  // half-spaces do not collide with one another
    }
}

/// A sphere touches in a single point.
void add_nearest(const Solid& sphere, const Solid& B, const Separation& s, ContactPoints& out)
{
    const Vec3 point = (s.point_a + s.point_b) * 0.5;
    const bool on_face = -s.gap > -out.margin() && is_flat_towards(B, -s.normal);
    out.add({point, s.normal, -s.gap, 0, on_face ? Pivot{.of = Pivot::Of::A, .arm = point - sphere.center()} : Pivot{}});
}

void collide_ordered(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b, ContactPoints& out)
{
    using enum ColliderKind;
    if (b.kind() == Plane) return collide_with_plane(a, X_a, X_b, out);
    if (is_surface(b.kind())) return collide_with_surface(a, X_a, b, X_b, out);
    if (a.kind() == Sphere && b.kind() == Sphere) return sphere_sphere(a.size().x, X_a.p, b.size().x, X_b.p, out);
    if (a.kind() == Sphere && b.kind() == Box) return sphere_box(a.size().x, X_a.p, b.size(), X_b, out);
    const Solid A(a, X_a), B(b, X_b);
    // A test of bounding spheres rejects most pairs.
    const double bounding_distance = A.extent() + A.radius() + B.extent() + B.radius() + out.margin();
    if (length_squared(B.center() - A.center()) > bounding_distance * bounding_distance) return;
    if (a.kind() == Sphere) return add_nearest(A, B, separation_of(A, B), out);
    if (a.kind() == Box && b.kind() == Box) return box_box(A, B, out);
    add_manifold(A, B, separation_of(A, B, std::max(0.0, out.margin())), out);
}
}  // namespace

bool meets(ColliderKind a, ColliderKind b)
{
    const auto open = [](ColliderKind kind) { return kind == ColliderKind::Plane || is_surface(kind); };
    return a != ColliderKind::None && b != ColliderKind::None && !(open(a) && open(b));
}

Separation separation(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b)
{
    if (!meets(a.kind(), b.kind())) return {HUGE_VAL, X_a.p, X_b.p, {0, 0, 1}};
    if (!in_order(a, X_a, b, X_b))
    {
        const Separation s = separation(b, X_b, a, X_a);
        return {s.gap, s.point_b, s.point_a, -s.normal, s.triangles};
    }
    if (is_surface(b.kind())) return separation_from_surface(a, X_a, b, X_b);
    const Solid A(a, X_a);
    return b.kind() == ColliderKind::Plane ? separation_from_plane(A, X_b) : separation_of(A, Solid(b, X_b));
}

void collide(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b, ContactPoints& out)
{
    if (!meets(a.kind(), b.kind())) return;
    if (in_order(a, X_a, b, X_b)) return collide_ordered(a, X_a, b, X_b, out);
    const std::size_t before = out.all().size();
    collide_ordered(b, X_b, a, X_a, out);
    const bool has_sides = a.kind() != ColliderKind::Plane && !is_surface(a.kind()) && b.kind() != ColliderKind::Sphere;
    for (ContactPoint& t : out.all().subspan(before))
    {
        t.normal = -t.normal;
        if (has_sides) t.feature = mirrored_feature(t.feature);
        if (t.pivot.of != Pivot::Of::Neither) t.pivot.of = t.pivot.of == Pivot::Of::A ? Pivot::Of::B : Pivot::Of::A;
    }
}

}  // namespace plab::detection
