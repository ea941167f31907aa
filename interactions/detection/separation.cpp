#include "separation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "box_axes.h"
#include "expand.h"

namespace plab::detection
{
namespace
{
/// Fallback direction, upwards, for coincident centres.
constexpr Vec3 kNoDirection{0, 0, 1};

Separation flipped(const Separation& s) { return {s.gap, s.point_b, s.point_a, -s.normal}; }

/// Of two cores with radii around them.
Separation with_radii(const Separation& cores, const Solid& A, const Solid& B)
{
    Separation s = cores;
    s.gap -= A.radius() + B.radius();
    s.point_a += A.radius() * s.normal, s.point_b -= B.radius() * s.normal;
    return s;
}

/// Two closest points with radii around them; `n_instead` is the normal if they coincide. The line between them is perpendicular
/// to `along` (unit, or 0); this is enforced, as rounding would hide it where they nearly coincide.
Separation of_points(const Vec3& a, double radius_a, const Vec3& b, double radius_b, const Vec3& n_instead, const Vec3& along = {})
{
    const Vec3 across = (b - a) - dot(b - a, along) * along;
    const double distance = length(across);
    Vec3 n = distance > 0 ? across / distance : n_instead;
    n = normalized(n - dot(n, along) * along);
    return {distance - (radius_a + radius_b), a + radius_a * n, b - radius_b * n, n};
}

/// The closest points of two segments (V. Lumelsky, On fast computation of distance between line segments, 1985): tries the
/// interior crossing and the four ends.
Separation segment_segment(const Solid& A, const Solid& B)
{
    const Vec3 u = A.axis(2), v = B.axis(2), r = B.pose().p - A.pose().p;
    const double la = A.size().z, lb = B.size().z;
    const Vec3 n = cross(u, v);
    const double nn = length_squared(n);
    constexpr double kParallel = 1e-24;  // squared sine
    double best = HUGE_VAL;
    Vec3 pa, pb;
    const auto offer = [&](double s, double t)
    {
        const Vec3 a = A.pose().p + s * u, b = B.pose().p + t * v;
        if (const double d = length_squared(b - a); d < best) best = d, pa = a, pb = b;
    };
    if (nn > kParallel)
    {
        const double s = dot(cross(r, v), n) / nn, t = dot(cross(r, u), n) / nn;
        if (std::fabs(s) < la && std::fabs(t) < lb && nn < 1e-6)
            offer(s, t);  // the cross product is too inaccurate to serve as the normal
        else if (std::fabs(s) < la && std::fabs(t) < lb)
        {
            const Vec3 a = A.pose().p + s * u, b = B.pose().p + t * v;
            const Vec3 across = n * ((dot(n, r) < 0 ? -1 : 1) / std::sqrt(nn));
            const double gap = dot(across, r) - (A.radius() + B.radius());
            return {gap, a + A.radius() * across, b - B.radius() * across, across};
        }
    }
    for (const double s : {-la, la}) offer(s, std::clamp(dot(A.pose().p + s * u - B.pose().p, v), -lb, lb));
    for (const double t : {-lb, lb}) offer(std::clamp(dot(B.pose().p + t * v - A.pose().p, u), -la, la), t);
    // For parallel segments, all points side by side are equally near. The middle of that range is chosen, so that neither end
    // is preferred.
    if (nn <= kParallel)
    {
        const double along = dot(u, r), low = std::max(-la, along - lb), high = std::min(la, along + lb);
        const double middle = 0.5 * (low + high);
        if (low < high)
            return of_points(A.pose().p + middle * u, A.radius(), B.pose().p + (middle * dot(u, v) - dot(v, r)) * v, B.radius(),
                             any_perpendicular(u), u);
    }
    return of_points(pa, A.radius(), pb, B.radius(), nn > 0 ? n / std::sqrt(nn) : any_perpendicular(u));
}

/// From a point inside a polyhedron, box or cylinder to its nearest face: signed distance to it (< 0) and normal, in S. Outside,
/// the largest signed distance to a face.
void leave(const Solid& S, const Vec3& c, double& outside, Vec3& n)
{
    if (S.core() == Core::Hull)
    {
        const Hull& hull = S.hull();
        std::size_t top = 0;
        for (std::size_t f = 0; f < hull.faces.size(); ++f)
            if (const double d = dot(hull.normals[f], c) - hull.offsets[f]; d > outside) outside = d, top = f;
        n = hull.normals[top];
        return;
    }
    if (S.core() == Core::Box)
    {
        for (int k = 0; k < 3; ++k)
            if (const double d = std::fabs(c[k]) - S.size()[k]; d > outside) outside = d, n = {}, n[k] = c[k] < 0 ? -1.0 : 1.0;
        return;
    }
    const double across = std::sqrt(c.x * c.x + c.y * c.y);
    outside = std::fabs(c.z) - S.size().z, n = {0, 0, c.z < 0 ? -1.0 : 1.0};
    if (across - S.size().x > outside) outside = across - S.size().x, n = across > 0 ? Vec3{c.x / across, c.y / across, 0} : Vec3{1, 0, 0};
}

/// The closest point of a hull to a point outside lies on a face that is visible from that point, and no farther away than any point of the
/// hull: the nearest middle of one excludes most others.
ClosestPoint closest_point_on_hull(const Solid& S, const Vec3& q)
{
    constexpr double kRounding = 1 + 0x1p-40;
    const Hull& hull = S.hull();
    const Vec3 c = S.to_local(q);
    const auto is_visible = [&](std::size_t f) { return dot(hull.normals[f], c) > hull.offsets[f]; };
    double nearest = HUGE_VAL;
    for (std::size_t f = 0; f < hull.faces.size(); ++f)
        if (const double d = length_squared(hull.middles[f] - c); d < nearest && is_visible(f)) nearest = d;
    nearest = std::sqrt(nearest);
    ClosestPoint best;
    double least = HUGE_VAL;
    for (std::size_t f = 0; f < hull.faces.size(); ++f)
    {
        const double within = (nearest + hull.reaches[f]) * kRounding;
        if (length_squared(hull.middles[f] - c) > within * within || !is_visible(f)) continue;
        const auto& v = hull.faces[f];
        const ClosestPoint closest = closest_point_on_facelet(c, {{hull.vertices[v[0]], hull.vertices[v[1]], hull.vertices[v[2]]}, 3});
        if (const double d = length_squared(c - closest.p); d < least) least = d, best = closest;
    }
    best.p = S.from_local(best.p), best.axis = S.from_local_direction(best.axis);
    return best;
}

/// A point with a radius against a box, cylinder or hull.
Separation point_solid(const Solid& P, const Solid& S)
{
    const Vec3 q = P.pose().p;
    const Vec3 c = S.to_local(q);
    double outside = -HUGE_VAL;
    Vec3 n;
    leave(S, c, outside, n);
    n = S.from_local_direction(n);
    Vec3 nearest = q - outside * n;
    if (outside > 0)
    {
        const ClosestPoint closest = S.core() == Core::Hull ? closest_point_on_hull(S, q) : S.closest_point(q, {});
        nearest = closest.p;
        const double distance = length(q - nearest);
        if (closest.flat == 2)
            n = closest.axis, outside = dot(n, q - nearest);
        else if (distance > 0)
            n = (q - nearest) / distance, outside = distance;
    }
    return {outside - P.radius(), q - P.radius() * n, nearest, -n};
}

Separation of_overlap(const Solid& A, const Solid& B, const Simplex& simplex)
{
    Overlap o = overlap_of(A, B, simplex);
    if (A.core() == Core::Box && B.core() == Core::Box)
    {
        // The separating axis is exact; the polytope supplies the points.
        const auto R = [](const Solid& s) { return rotation_matrix(s.pose().q); };
        const BoxAxis axis = find_box_axis(A.size(), R(A), A.pose().p, B.size(), R(B), B.pose().p, HUGE_VAL);
        if (-axis.gap <= o.depth) o.normal = axis.normal, o.depth = -axis.gap;
    }
    return {-o.depth, o.a, o.b, o.normal};
}
/// The gap between two parallel planes that separate the solids is a lower bound of the distance, and closest points are exact if the
/// planes perpendicular to their normal reach it. Where the gap is so small that they do not, the direction is searched for with B moved
/// further away.
Separation of_gap(const Solid& A, const Solid& B, const NearestPair& near, const Simplex& simplex)
{
    if (near.proven) return {near.gap, near.a, near.b, near.normal};
    const double enough = 1e-14 * (A.extent() + B.extent() + near.gap);
    Overlap best = refine(A, B, near.normal, simplex);
    if (near.gap + best.depth > enough)
        if (const Overlap other = overlap_of(A, B, {}); other.depth < best.depth) best = other;
    return {-best.depth, best.a, best.b, best.normal};
}

/// The cores where a point of A, its furthest one towards a flat face of B, is over the inside of that face: no search is needed, however
/// level A is. If they overlap, B contains a prism around the point with a clearance of at least the depth to its sides and far end, and to
/// leave that in any direction takes at least the depth to the face.
std::optional<Separation> over_a_face(const Solid& A, const Solid& B)
{
    const Vec3& half = B.size();
    const Vec3 c = B.to_local(A.center());
    int k = 2;
    if (B.core() == Core::Box)
        for (const int j : {0, 1})
            if (std::fabs(c[j]) - half[j] > std::fabs(c[k]) - half[k]) k = j;
    if (B.core() != Core::Box && B.core() != Core::Cylinder) return {};
    const double side = c[k] < 0 ? -1.0 : 1.0;
    const Vec3 n = side * B.axis(k), a = A.support(-n), l = B.to_local(a);
    const double gap = side * l[k] - half[k], depth = std::max(0.0, -gap);
    double clearance = half[k] - depth;
    if (B.core() == Core::Cylinder) clearance = std::min(clearance, half.x - std::hypot(l.x, l.y));
    if (B.core() == Core::Box)
        for (int j = 0; j < 3; ++j)
            if (j != k) clearance = std::min(clearance, half[j] - std::fabs(l[j]));
    if (!(clearance >= depth)) return {};
    return Separation{gap, a, a - gap * n, -n};
}
}  // namespace

Separation separation_of(const Solid& A, const Solid& B, double beyond)
{
    const bool line_a = A.core() <= Core::Segment, line_b = B.core() <= Core::Segment;
    if (A.core() == Core::Point && B.core() == Core::Point) return of_points(A.pose().p, A.radius(), B.pose().p, B.radius(), kNoDirection);
    if (A.core() == Core::Point && B.core() == Core::Segment)
    {
        const ClosestPoint closest = B.closest_point(A.pose().p, {});
        return of_points(A.pose().p, A.radius(), closest.p, B.radius(), any_perpendicular(B.axis(2)), closest.axis);
    }
    if (line_a && line_b)
        return A.core() == Core::Segment && B.core() == Core::Segment ? segment_segment(A, B) : flipped(separation_of(B, A, beyond));
    if (A.core() == Core::Point) return point_solid(A, B);
    if (B.core() == Core::Point) return flipped(point_solid(B, A));

    // Two boxes have their contacts by other means (box_axes.h). For their gap the search gives a level box a point in the middle of an
    // edge that both share; with a corner instead, a stack that falls by 0.1 mm without friction did not come to rest
    // (sleeping_state_test.cpp).
    const bool are_boxes = A.core() == Core::Box && B.core() == Core::Box;
    std::optional<Separation> simple;
    if (!are_boxes) simple = over_a_face(A, B);
    if (!are_boxes && !simple)
        if (const auto other = over_a_face(B, A)) simple = flipped(*other);
    if (simple) return with_radii(*simple, A, B);

    Simplex simplex;
    const NearestPair near = nearest_pair(A, B, beyond + A.radius() + B.radius(), simplex);
    if (near.beyond) return {near.gap - (A.radius() + B.radius()), {}, {}, {}};
    return with_radii(near.apart ? of_gap(A, B, near, simplex) : of_overlap(A, B, simplex), A, B);
}

Separation separation_from_plane(const Solid& a, const Pose& X_plane)
{
    const Vec3 n = rotate(X_plane.q, {0, 0, 1});
    const Vec3 p = a.support(-n);
    const double gap = dot(n, p - X_plane.p) - a.radius();
    const Vec3 lowest = p - a.radius() * n;
    return {gap, lowest, lowest - gap * n, -n};
}

}  // namespace plab::detection
