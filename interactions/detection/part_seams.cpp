#include "part_seams.h"

#include <algorithm>

#include "solid.h"

namespace plab::detection
{
namespace
{

/// Normals that are as close as this (cosine) are those of one surface: the contact is no edge.
constexpr double kSameSurface = 0.999;
/// Of the smaller part's size: an overlap up to the first is none, and bodies with a gap up to the second lie on one another.
constexpr double kNoOverlap = 1e-8, kTouching = 1e-4;

/// Round parts have no edges; half-spaces and surfaces are not passed.
bool has_edges(const Collider& c)
{
    return c.kind() == ColliderKind::Box || c.kind() == ColliderKind::Hull || c.kind() == ColliderKind::Cylinder;
}

/// m: the gap between the projections of two solids onto n (unit, A to B).
double width_along(const Solid& A, const Solid& B, const Vec3& n) { return dot(B.support(-n) - A.support(n), n) - A.radius() - B.radius(); }

}  // namespace

double seam_margin(const Collider& a, const Collider& b)
{
    return has_edges(a) && has_edges(b) ? kNoOverlap * std::min(length(a.bound_half()), length(b.bound_half())) : 0.0;
}

void mark_seams(std::span<PartContact> contacts)
{
    for (PartContact& c : contacts)
    {
        if (!has_edges(*c.a) || !has_edges(*c.b)) continue;
        const Solid A(*c.a, c.X_a), B(*c.b, c.X_b);
        const double size = std::min(A.extent() + A.radius(), B.extent() + B.radius());
        c.passes = std::ranges::any_of(contacts,
                                       [&](const PartContact& on)
                                       {
                                           if (&on == &c || on.passes || on.depth < -kTouching * size) return false;
                                           if (dot(on.normal, c.normal) > kSameSurface) return false;
                                           // What has sunk in is compared with what it lies on.
                                           return width_along(A, B, on.normal) >= -(kNoOverlap * size + std::max(0.0, on.depth));
                                       });
    }
}

}  // namespace plab::detection
