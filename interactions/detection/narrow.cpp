#include "narrow.h"

#include <cmath>

#include "exact_pairs.h"
#include "hull_pairs.h"

namespace plab::detection
{
namespace
{
/// Which of the 27 regions of a box (inside, faces, edges, corners) a point on its surface is nearest to. Steady under
/// rounding, where an order of the points by position would not be.
std::uint32_t region(const Vec3& half, const Vec3& p_S)
{
    constexpr double kBand = 1e-3;  // of the half extent
    std::uint32_t code = 0;
    for (int k = 0; k < 3; ++k)
    {
        const bool at_end = std::fabs(p_S[k]) > (1 - kBand) * half[k];
        code = 3 * code + (at_end ? (p_S[k] < 0 ? 0u : 2u) : 1u);
    }
    return code;
}

/// Two boxes by ODE (separating axes, clipped faces). Its normals point from the second geometry to the first.
void box_box(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b, Touches& out)
{
    constexpr int kMost = 8;
    std::array<dContactGeom, kMost> found;
    const int n = dCollide(a.probe(0, X_a), b.probe(1, X_b), kMost, found.data(), sizeof(dContactGeom));
    for (int i = 0; i < n; ++i)
    {
        const dContactGeom& g = found[static_cast<std::size_t>(i)];
        const Vec3 point{g.pos[0], g.pos[1], g.pos[2]};
        const Vec3 normal = normalized(Vec3{-g.normal[0], -g.normal[1], -g.normal[2]});
        out.add({point, normal, g.depth,
                 27 * region(a.size(), rotate_back(X_a.q, point - X_a.p)) + region(b.size(), rotate_back(X_b.q, point - X_b.p))});
    }
}

/// Pairs with the kinds in the order of ColliderKind.
void collide_ordered(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b, Touches& out)
{
    using enum ColliderKind;
    if (a.kind() == Sphere)
    {
        if (b.kind() == Sphere) return sphere_sphere(a.size().x, X_a.p, b.size().x, X_b.p, out);
        if (b.kind() == Plane) return sphere_plane(a.size().x, X_a.p, X_b, out);
        if (b.kind() == Box) return sphere_box(a.size().x, X_a.p, b.size(), X_b, out);
        return sphere_hull(a.size().x, X_a.p, b.hull(), X_b, out);
    }
    if (a.kind() == Plane) return;  // half-spaces do not collide with one another
    if (b.kind() == Box) return box_box(a, X_a, b, X_b, out);
    hull_hull(a.hull(), X_a, b.hull(), X_b, out);
}
}  // namespace

void collide(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b, Touches& out)
{
    using enum ColliderKind;
    if (a.kind() == None || b.kind() == None) return;
    const auto flip_from = [&](std::size_t first)
    {
        for (Touch& t : out.all().subspan(first)) t.normal = -t.normal;
    };
    const std::size_t before = out.all().size();
    if (a.kind() == Plane && b.kind() != Plane)
    {
        collide(b, X_b, a, X_a, out);
        flip_from(before);
        return;
    }
    if (b.kind() == Plane && a.kind() == Box) return box_plane(a.size(), X_a, X_b, out);
    if (b.kind() == Plane && a.kind() == Hull) return hull_plane(a.hull(), X_a, X_b, out);
    if (a.kind() <= b.kind()) return collide_ordered(a, X_a, b, X_b, out);
    collide_ordered(b, X_b, a, X_a, out);
    flip_from(before);
}

}  // namespace plab::detection
