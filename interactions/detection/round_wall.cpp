// Contacts with the inside of a bowl (a part of a sphere) or a bore (a cylinder) of radius R. c and p are relative to its
// centre, or perpendicular to its axis.
//
//   gap of a ball  = R - |c| - r  (or its distance to the circle of the rim)
//   gap of a solid = R - max |p| over its corners: |p| is convex, so its maximum over the solid is at a corner
//
// An edge of the solid may cross the plane of the opening, at a point q, and touch the rim. With e along the edge and t along
// the rim, the two are apart along m = e x t / |e x t|, directed towards the wall, by (rim - q) . m. This is exact where they
// touch. As the rim is a circle rather than a line, it is wrong by gap^2 / (2 R) otherwise, which is subtracted.
#include <algorithm>
#include <cmath>

#include "manifold.h"
#include "surface_contacts.h"

namespace plab::detection
{
namespace
{

/// Sine up to which the end of a cylinder counts as level in a bowl; a hundredth of it: up to which a cylinder lies along a
/// bore.
constexpr double kLevel = 0.1;

/// The circle at which the surface ends.
struct Rim
{
    double radius = 0, z = 0;
};

class RoundWall
{
public:
    explicit RoundWall(const Collider& c) : bowl_(c.kind() == ColliderKind::Bowl), radius_(c.size().x), rim_height_(c.size().z)
    {
        if (bowl_)
            rims_[count_++] = {std::sqrt(std::fmax(0.0, (radius_ - rim_height_) * (radius_ + rim_height_))), rim_height_};
        else
            rims_[count_++] = {radius_, -rim_height_}, rims_[count_++] = {radius_, rim_height_};
        if (bowl_ && rim_height_ >= radius_) count_ = 0;  // a closed shell
    }

    bool is_bowl() const { return bowl_; }
    double radius() const { return radius_; }
    std::span<const Rim> rims() const { return {rims_.data(), count_}; }
    /// Outward direction from the centre or the axis.
    Vec3 from_middle(const Vec3& p) const { return bowl_ ? p : Vec3{p.x, p.y, 0}; }
    Vec3 outwards(const Vec3& p) const
    {
        const Vec3 r = from_middle(p);
        const double size = length(r);
        return size > 0 ? r / size : (bowl_ ? Vec3{0, 0, -1} : Vec3{1, 0, 0});
    }
    /// Whether the nearest point of the complete sphere or cylinder belongs to the surface.
    bool faces(const Vec3& p) const
    {
        if (!bowl_) return std::fabs(p.z) <= rim_height_;
        return rim_height_ >= radius_ || p.z * radius_ <= rim_height_ * length(p) || p == Vec3{};
    }

private:
    bool bowl_;
    double radius_, rim_height_;
    std::array<Rim, 2> rims_{};
    std::size_t count_ = 0;
};

Vec3 on_rim(const Rim& rim, const Vec3& p)
{
    const double across = std::sqrt(p.x * p.x + p.y * p.y);
    return across > 0 ? Vec3{rim.radius * p.x / across, rim.radius * p.y / across, rim.z} : Vec3{rim.radius, 0, rim.z};
}

/// Of a corner, or of a round end of `radius` with the `arm` to its contact point, towards the wall at n.
Pivot pivot_in(const RoundWall& wall, double radius, const Vec3& n, const Vec3& arm)
{
    constexpr double kMost = 1e30;  // 1/m: a curvature that a float can hold
    const double curvature = 1 / (wall.radius() - radius);
    if (!(curvature > 0 && curvature < kMost)) return {};
    return {.of = Pivot::Of::A, .hollow = Hollow::of((wall.is_bowl() ? n : Vec3{0, 0, 1}) * curvature), .arm = arm};
}

void meet_ball(const Vec3& c, double radius, std::uint32_t feature, const RoundWall& wall, MeetingSink& out)
{
    if (wall.faces(c))
    {
        const Vec3 n = wall.outwards(c);
        const double outside = wall.radius() - length(wall.from_middle(c)), gap = outside - radius;
        // A ball that is entirely behind the wall has not come from inside.
        if (outside >= -radius && gap < out.limit())
            out.offer({gap, c + radius * n, c + outside * n, n, feature, pivot_in(wall, radius, n, n * (radius + 0.5 * gap))});
        return;
    }
    for (const Rim& rim : wall.rims())
    {
        const Vec3 p = on_rim(rim, c);
        const double distance = length(p - c), gap = distance - radius;
        const Vec3 n = distance > 0 ? (p - c) / distance : wall.outwards(c);
        if (gap < out.limit()) out.offer({gap, c + radius * n, p, n, feature});
    }
}

/// The point on a rim of K (centre m, radius a, perpendicular to u) that is furthest from the axis of a bore. r^2 is a sum of
/// cosines of the angle and of twice the angle; it is maximised by the iteration w -> direction of (m + a w) across the axis,
/// then by Newton's method.
Vec3 furthest_of_rim(const Vec3& m, double a, const Vec3& u, const Vec3& start)
{
    const auto across = [&](const Vec3& d) { return d - dot(d, u) * u; };
    Vec3 w = normalized(across(start));
    if (w == Vec3{}) return m;
    for (int i = 0; i < 24; ++i)
    {
        const Vec3 p = m + a * w, next = normalized(across({p.x, p.y, 0}));
        if (next == Vec3{} || length_squared(next - w) < 1e-24) break;
        w = next;
    }
    for (int i = 0; i < 6; ++i)
    {
        // r^2(t) = |P (m + a (w cos t + v sin t))|^2, P: across z
        const Vec3 v = cross(u, w), p = m + a * w;
        const double slope = a * (p.x * v.x + p.y * v.y);
        const double curvature = a * a * (v.x * v.x + v.y * v.y) - a * (p.x * w.x + p.y * w.y);
        if (!(curvature < 0) || std::fabs(slope) >= -curvature) break;
        w = normalized(w - (slope / curvature) * v);
    }
    return m + a * w;
}

/// The points of K that may be furthest from the centre or axis.
template <class Visit>
void visit_outermost(const Solid& K, const RoundWall& wall, Visit&& visit)
{
    if (K.core() != Core::Cylinder)
        return visit_corners(K, {}, [&](const Vec3& p, std::uint32_t number, const Vec3&) { visit(p, number); });
    const Vec3 u = K.axis(2);
    for (std::uint32_t end = 0; end < 2; ++end)
    {
        const Vec3 m = K.pose().p + (end == 1 ? K.size().z : -K.size().z) * u, out = wall.outwards(m);
        if (wall.is_bowl())
        {
            // An end that is level in a bowl touches with its whole rim.
            const RimPoints rim = rim_points(K, end == 1, wall.from_middle(m) == Vec3{} ? Vec3{} : out);
            const bool level = length_squared(cross(out, u)) < kLevel * kLevel;
            for (std::uint32_t i = rim.count; i-- > 0;)
                if (level || rim.id[i] == RimPoints::kFurthest) visit(rim.p[i], 8 * end + rim.id[i]);
            continue;
        }
        // In a bore, a rim may touch at two places.
        const Vec3 side = cross(u, Vec3{0, 0, 1});
        if (length_squared(side) < kLevel * kLevel * 1e-4)
        {
            visit(furthest_of_rim(m, K.size().x, u, out), 8 * end + RimPoints::kFurthest);
            continue;
        }
        visit(furthest_of_rim(m, K.size().x, u, side), 8 * end + RimPoints::kFurthest);
        visit(furthest_of_rim(m, K.size().x, u, -side), 8 * end + RimPoints::kFurthest + 1);
    }
}

void meet_edge(const Vec3& p, const Vec3& q, double radius, std::uint32_t number, const RoundWall& wall, MeetingSink& out)
{
    std::uint32_t which = 0;
    for (const Rim& rim : wall.rims())
    {
        const std::uint32_t feature = crossing_feature(number, which++);
        const double begin = p.z - rim.z, end = q.z - rim.z;
        if (!((begin < 0) != (end < 0))) continue;
        const Vec3 x = p + (begin / (begin - end)) * (q - p), closest = on_rim(rim, x),
                   tangent{-closest.y / rim.radius, closest.x / rim.radius, 0};
        Vec3 m = normalized(cross(q - p, tangent));
        if (m == Vec3{}) continue;
        if (m.x * closest.x + m.y * closest.y < 0) m = -m;
        const double apart = dot(closest - x, m), gap = apart - radius - apart * apart / (2 * rim.radius);
        if (gap < out.limit() && gap > -rim.radius) out.offer({gap, closest - (apart - radius) * m, closest, m, feature});
    }
}

void meet_edges(const Solid& K, const RoundWall& wall, MeetingSink& out)
{
    const Vec3& h = K.size();
    switch (K.core())
    {
        case Core::Segment:
            return meet_edge(K.pose().p - h.z * K.axis(2), K.pose().p + h.z * K.axis(2), K.radius(), 0, wall, out);
        case Core::Box:
            for (std::uint32_t i = 0; i < 8; ++i)
                for (std::uint32_t k = 0; k < 3; ++k)
                {
                    if (i & (1u << k)) continue;
                    const auto corner = [&](std::uint32_t c) {
                        return K.from_local({c & 1 ? h.x : -h.x, c & 2 ? h.y : -h.y, c & 4 ? h.z : -h.z});
                    };
                    meet_edge(corner(i), corner(i | (1u << k)), 0, 3 * i + k, wall, out);
                }
            return;
        case Core::Hull:
            for (std::uint32_t i = 0; i < K.hull().edges.size(); ++i)
            {
                const auto [a, b] = K.hull().edges[i];
                meet_edge(K.from_local(K.hull().vertices[a]), K.from_local(K.hull().vertices[b]), 0, i, wall, out);
            }
            return;
        case Core::Cylinder:
        {
            // The line along the barrel that is furthest from the centre where it crosses the opening.
            const Vec3 u = K.axis(2), out_of_middle = wall.outwards(K.pose().p),
                       across = normalized(out_of_middle - dot(out_of_middle, u) * u);
            const Vec3 aside = K.pose().p + h.x * across;
            return meet_edge(aside - h.z * u, aside + h.z * u, 0, 0, wall, out);
        }
        case Core::Point:
            return;
    }
}
}  // namespace

void meet_round_wall(const Solid& K, const Collider& collider, MeetingSink& out)
{
    const RoundWall wall(collider);
    if (K.core() == Core::Point) return meet_ball(K.pose().p, K.radius(), 0, wall, out);
    if (length(wall.from_middle(K.center())) >= wall.radius()) return;  // the centre of K is behind the wall
    visit_outermost(K, wall,
                    [&](const Vec3& p, std::uint32_t number)
                    {
                        const std::uint32_t feature = corner_feature(true, number);
                        if (K.core() == Core::Segment) return meet_ball(p, K.radius(), feature, wall, out);
                        if (!wall.faces(p))
                        {
                            // Excludes edges that have just come in: nearer to the wall than to the rim.
                            for (const Rim& rim : wall.rims())
                            {
                                const Vec3 closest = on_rim(rim, p);
                                const double gap = length(closest - p);
                                if (gap > 0 && gap < out.limit() && length(wall.from_middle(p)) < wall.radius())
                                    out.offer({gap, p, closest, (closest - p) / gap, feature});
                            }
                            return;
                        }
                        const Vec3 n = wall.outwards(p);
                        const double gap = wall.radius() - length(wall.from_middle(p));
                        // The point of a rim that is furthest from the centre is not fixed in the cylinder.
                        const bool is_fixed = K.core() != Core::Cylinder || (number & 7) < RimPoints::kFurthest;
                        if (gap < out.limit()) out.offer({gap, p, p + gap * n, n, feature, is_fixed ? pivot_in(wall, 0, n, {}) : Pivot{}});
                    });
    meet_edges(K, wall, out);
}

}  // namespace plab::detection
