// Seams: where a body passes from what it lies on to a body beside it whose surface is flush.
//
// Just before a box that lies on a tile reaches the next tile, the nearest points of the two lie on their edges, and the normal between
// them points against the motion: rounding alone decides whether the box slides on or hits an edge. But what is no higher than the surface
// on which a body lies is no obstacle to it. The surfaces are compared by support functions along the normal of that surface, which says
// nothing about bodies that are not convex and holds then, too: what one direction separates is apart.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "plab/rotation.h"
#include "plab/surface.h"
#include "simulation/contacts/contact_book.h"
#include "simulation/contacts/support.h"

namespace plab::simulation
{
namespace
{

/// Normals that are as close as this (cosine) are those of one surface: the contact is no edge.
constexpr double kSameSurface = 0.999;
/// A face is flat across a direction within this (rad), so that its height along it is that of its plane.
constexpr double kFlat = 0x1p-20;

/// A body that lies on fewer points may roll.
constexpr std::uint32_t kFacePoints = 3;

/// m: how far a body reaches along n, from the origin of W; infinite if it has a half-space.
double reach(const world::HostTables& host, Ref body, const Vec3& n)
{
    for (const Ref shape : host.bodies.shapes[body.index])
        if (host.shapes.geometry[shape.index].kind == GeometryKind::Plane) return std::numeric_limits<double>::infinity();
    const Bodies& bodies = host.bodies;
    return dot(bodies.position[body.index], n) + support(bodies, host.shapes, body.index, bodies.orientation[body.index], n);
}

const Geometry* only_shape(const world::HostTables& host, Ref body)
{
    const RefList& shapes = host.bodies.shapes[body.index];
    return shapes.size() == 1 ? &host.shapes.geometry[shapes.front().index] : nullptr;
}

bool is_convex(const Geometry* g) { return g && g->kind != GeometryKind::Compound && surface_of(*g) == Surface::None; }

/// m: where the flat face of a half-space or a box that faces n (unit, W) is along n; -inf if the body has no such face. What lies on the
/// face may have sunk in: the face counts and not what lies on it.
double face_along(const world::HostTables& host, Ref body, const Vec3& n)
{
    constexpr double kNone = -std::numeric_limits<double>::infinity();
    const Geometry* g = only_shape(host, body);
    if (!g || (g->kind != GeometryKind::Plane && g->kind != GeometryKind::Box)) return kNone;
    const Bodies& bodies = host.bodies;
    const Quat q = bodies.orientation[body.index];
    const Vec3 in_shape = rotate_back(q * g->pose.q, n);
    const auto is_flat = [&](const Vec3& axis, double sign) { return length(in_shape - axis * sign) <= kFlat; };
    if (g->kind == GeometryKind::Plane)
        return is_flat({0, 0, 1}, 1) ? dot(bodies.position[body.index] + rotate(q, g->pose.p - bodies.center_B[body.index]), n) : kNone;
    for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        if (is_flat(axis, 1) || is_flat(axis, -1)) return reach(host, body, n);
    return kNone;
}

}  // namespace

/// Whether `body`, which lies on `below` in the direction `down`, passes `other` there although their nearest points lie in the direction
/// `towards`.
bool ContactBook::passes_along(Ref body, Ref other, const Vec3& towards, Ref below, const Vec3& down) const
{
    if (below == other || dot(towards, down) > kSameSurface) return false;
    const world::HostTables& host = step_.world.host();
    double lowest = -reach(host, body, down);
    if (is_convex(only_shape(host, body))) lowest = std::max(lowest, face_along(host, below, -down));
    return reach(host, other, -down) <= lowest + overlap_tolerance(body, other);
}

/// Round bodies have none, so that nothing is hit by or catches on one.
bool ContactBook::has_edges(Ref body) const
{
    const Geometry* g = only_shape(step_.world.host(), body);
    return !g || (g->kind != GeometryKind::Sphere && g->kind != GeometryKind::Capsule && g->kind != GeometryKind::Plane);
}

/// The direction from `body` to a surface on which it lies, along which it passes `other` (seam_between).
std::optional<Vec3> ContactBook::seam_below(Ref body, Ref other, const Vec3& towards, std::span<const FoundContact> beside)
{
    const std::uint32_t group = step_.world.host().bodies.dynamic(body.index) ? step_.groups.of(body) : kNoIndex;
    if (group == kNoIndex) return {};
    const auto lies_on = [&](Ref first, Ref second, const Vec3& n) -> std::optional<Vec3>
    {
        if (first != body && second != body) return {};
        const Vec3 down = first == body ? n : -n;
        if (!passes_along(body, other, towards, first == body ? second : first, down)) return {};
        return down;
    };
    for (const FoundContact& f : beside)
        if (const auto down = lies_on(f.contact.a, f.contact.b, f.contact.normal)) return down;
    resting_.find(std::span(&group, 1), seam_places_);
    for (const std::uint32_t place : seam_places_)
    {
        const PairState& p = std::as_const(cache_).pairs()[place];
        if (p.ahead || (towards == Vec3{} && p.count < kFacePoints)) continue;
        if (const auto down = lies_on(p.a, p.b, p.normal)) return down;
    }
    return {};
}

std::optional<Vec3> ContactBook::seam_between(Ref a, Ref b, const Vec3& normal, std::span<const FoundContact> beside)
{
    if (!has_edges(a) || !has_edges(b)) return {};
    if (const auto down = seam_below(a, b, normal, beside)) return down;
    if (const auto down = seam_below(b, a, -normal, beside)) return -*down;
    return {};
}

bool ContactBook::passes_over(std::span<const FoundContact> contacts)
{
    const auto passes = [&](const FoundContact& f) { return seam_between(f.contact.a, f.contact.b, f.contact.normal).has_value(); };
    return !contacts.empty() && std::ranges::all_of(contacts, passes);
}

void ContactBook::drop_passed(std::vector<FoundContact>& impact)
{
    // What is dropped carries nobody, but what it is compared with has to stay in place.
    const auto passes = [&](const FoundContact& f) { return seam_between(f.contact.a, f.contact.b, f.contact.normal, impact).has_value(); };
    passed_.assign(impact.size(), 0);
    std::ranges::transform(impact, passed_.begin(), passes);
    std::size_t i = 0;
    std::erase_if(impact, [&](const FoundContact&) { return passed_[i++] != 0; });
}

/// Drops the contacts, sorted, of persistent pairs that do not press and pass one another over a seam.
void ContactBook::drop_passed_pairs(std::vector<FoundContact>& contacts)
{
    std::size_t near = 0, kept = 0;
    for (std::size_t i = 0, end = 0; i < contacts.size(); i = end)
    {
        for (end = i; end < contacts.size() && same_pair(contacts[end], contacts[i]);) ++end;
        if (!pressed(*find_pair(contacts[i], near)) && passes_over(std::span(contacts).subspan(i, end - i))) continue;
        if (kept == i)
            kept = end;
        else
            for (std::size_t k = i; k < end; ++k) contacts[kept++] = contacts[k];
    }
    contacts.resize(kept);
}

}  // namespace plab::simulation
