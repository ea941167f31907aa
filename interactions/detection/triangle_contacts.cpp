// Contacts of solids with triangle meshes.
//
// A ball touches where its distance to the surface has a local minimum: over a face; at a convex edge, if the direction lies
// between the normals of both sides; at a corner that protrudes from all its edges. Inner edges of flat or concave regions are
// none of these, so a sliding ball does not catch on them.
//
// If two polyhedra touch, either a corner of one lies on a face of the other, or two edges cross. Therefore two tests suffice:
// corners of the solid K over faces, along the face normal; and K against each sharp edge, treated as a thin rod, along a
// direction that leads away from the surface on both sides of that edge.
#include <algorithm>
#include <cmath>

#include "manifold.h"
#include "pivots.h"
#include "separation.h"
#include "surface_contacts.h"

namespace plab::detection
{
namespace
{

using Surface = TriangleSurface;
/// Sine of the angle by which a direction may lead into the surface.
constexpr double kAlong = 1e-9;
/// Fraction of the solid's size by which a corner may lie beside a face: allows for rounding, so that no corner falls between
/// two faces.
constexpr double kBeside = 1e-13;
/// A corner that is inside touches all faces that are at most this many times as deep as the nearest one, or less deep than this
/// fraction of the size: floor and wall of a concave corner.
constexpr double kMuchNearer = 4, kShallow = 1e-4;
/// Fraction of the solid's size within which a point counts as the end of an edge.
constexpr double kAtEnd = 1e-12;

/// The point of a triangle nearest to a given point (C. Ericson, Real-time collision detection, 2005, 5.1.5).
struct TriangleClosestPoint
{
    enum class At : std::uint8_t
    {
        Corner,
        Edge,
        Face,
    };
    Vec3 p;
    At at = At::Face;
    std::size_t which = 0;  ///< which corner or edge of the triangle
};

TriangleClosestPoint closest_point_on(const Surface& s, const Surface::Triangle& t, const Vec3& q)
{
    using enum TriangleClosestPoint::At;
    const Vec3 &a = s.point(t.corner[0]), &b = s.point(t.corner[1]), &c = s.point(t.corner[2]);
    const Vec3 ab = b - a, ac = c - a, aq = q - a, bq = q - b, cq = q - c;
    const double d1 = dot(ab, aq), d2 = dot(ac, aq), d3 = dot(ab, bq), d4 = dot(ac, bq), d5 = dot(ab, cq), d6 = dot(ac, cq);
    if (d1 <= 0 && d2 <= 0) return {a, Corner, 0};
    if (d3 >= 0 && d4 <= d3) return {b, Corner, 1};
    if (d6 >= 0 && d5 <= d6) return {c, Corner, 2};
    if (const double vc = d1 * d4 - d3 * d2; vc <= 0 && d1 >= 0 && d3 <= 0) return {a + (d1 / (d1 - d3)) * ab, Edge, 0};
    if (const double va = d3 * d6 - d5 * d4; va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return {b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b), Edge, 1};
    if (const double vb = d5 * d2 - d1 * d6; vb <= 0 && d2 >= 0 && d6 <= 0) return {a + (d2 / (d2 - d6)) * ac, Edge, 2};
    return {q - dot(t.normal, aq) * t.normal, Face, 0};
}

/// The point of the surface nearest to a given point.
class NearestPlace
{
public:
    /// Searches no further than `most` (m).
    NearestPlace(const Surface& s, const Vec3& c, double most) : s_(s), c_(c)
    {
        double least = most;
        s_.visit_near(
            c_, [&] { return least; },
            [&](std::uint32_t t)
            {
                ++visited_;
                const TriangleClosestPoint closest = closest_point_on(s_, s_.triangles()[t], c_);
                const double distance = length(closest.p - c_);
                if (distance < least || (distance == least && (nearest_ == Surface::kNone || t < nearest_)))
                    least = distance, nearest_ = t, closest_ = closest;
            });
    }
    bool found() const { return nearest_ != Surface::kNone; }
    std::size_t visited() const { return visited_; }  ///< number of triangles
    std::uint32_t triangle() const { return nearest_; }
    const Vec3& point() const { return closest_.p; }
    double distance() const { return length(c_ - closest_.p); }
    bool behind() const { return !on_border() && dot(c_ - closest_.p, normal()) < 0; }
    Vec3 normal() const
    {
        const Surface::Triangle& t = triangle(nearest_);
        if (closest_.at == TriangleClosestPoint::At::Face) return t.normal;
        if (closest_.at == TriangleClosestPoint::At::Corner) return normalized(s_.corner_normal(t.corner[closest_.which]));
        const Surface::Edge& e = edge_there();
        return e.border() ? t.normal : normalized(triangle(e.side[0]).normal + triangle(e.side[1]).normal);
    }
    /// Direction from the surface to the point in front of it.
    Vec3 direction() const { return flat_there() || !(distance() > 0) ? triangle(nearest_).normal : (c_ - closest_.p) / distance(); }
    /// Whether the surface is flat there, i.e. no sharp edge or corner.
    bool flat_there() const
    {
        if (closest_.at == TriangleClosestPoint::At::Face) return true;
        if (closest_.at == TriangleClosestPoint::At::Edge) return !edge_there().sharp;
        return !s_.sharp_corner(triangle(nearest_).corner[closest_.which]);
    }

private:
    const Surface::Triangle& triangle(std::uint32_t t) const { return s_.triangles()[t]; }
    const Surface::Edge& edge_there() const { return s_.edges()[triangle(nearest_).edge[closest_.which]]; }
    bool on_border() const
    {
        if (closest_.at == TriangleClosestPoint::At::Face) return false;
        if (closest_.at == TriangleClosestPoint::At::Edge) return edge_there().border();
        return s_.border_corner(triangle(nearest_).corner[closest_.which]);
    }

    const Surface& s_;
    Vec3 c_;
    std::uint32_t nearest_ = Surface::kNone;
    std::size_t visited_ = 0;
    TriangleClosestPoint closest_;
};

/// A ball at c, in front of the surface or behind it by at most its radius.
class BallOnTriangles
{
public:
    BallOnTriangles(const Surface& s, const Vec3& c, double radius, MeetingSink& out) : s_(s), c_(c), radius_(radius), out_(out) {}

    void run()
    {
        const NearestPlace nearest(s_, c_, radius_ + out_.limit());
        out_.note_triangles(nearest.visited());
        if (!nearest.found()) return;
        const double distance = nearest.distance();
        if (nearest.behind())
        {
            // A ball completely behind the surface has not come from the front.
            const Vec3 n = distance > 0 ? (c_ - nearest.point()) / distance : -nearest.normal();
            if (distance <= radius_) offer(-distance, n, nearest.point(), nearest.triangle(), nearest.flat_there());
            return;
        }
        // The nearest place is always a contact; rounding may assign it to no face.
        const double outside = dot(nearest.direction(), c_ - nearest.point());
        offer(outside, -nearest.direction(), nearest.point(), nearest.triangle(), nearest.flat_there());
        const double limit = radius_ + out_.limit();
        if (!(outside < limit)) return;
        const Vec3 by{limit, limit, limit};
        s_.visit_box(c_ - by, c_ + by,
                     [&](std::uint32_t t)
                     {
                         out_.note_triangles(1);
                         if (t != nearest.triangle()) offer_least(t);
                     });
    }

private:
    /// `outside`: distance of the centre, m; `n` points from the centre to the surface.
    void offer(double outside, const Vec3& n, const Vec3& closest, std::uint32_t t, bool on_face)
    {
        const double gap = outside - radius_;
        const Pivot pivot{.of = Pivot::Of::A, .arm = n * (outside - 0.5 * gap)};
        if (gap < out_.limit()) out_.offer({gap, c_ + radius_ * n, closest, n, t, on_face ? pivot : Pivot{}});
    }

    void offer_least(std::uint32_t t)
    {
        const Surface::Triangle& triangle = s_.triangles()[t];
        const TriangleClosestPoint closest = closest_point_on(s_, triangle, c_);
        const Vec3 d = c_ - closest.p;
        const double distance = length(d);
        if (closest.at == TriangleClosestPoint::At::Face)
        {
            const double outside = dot(triangle.normal, d);
            if (outside > 0) offer(outside, -triangle.normal, closest.p, t, true);
            return;
        }
        if (!(distance > 0)) return;
        if (closest.at == TriangleClosestPoint::At::Edge)
        {
            const Surface::Edge& e = s_.edges()[triangle.edge[closest.which]];
            if (!e.sharp || e.side[0] != t) return;
            for (std::size_t i = 0; i < (e.border() ? 1u : 2u); ++i)
                if (dot(d, s_.inward(e, i)) > 0) return;
        }
        else
        {
            const std::uint32_t corner = triangle.corner[closest.which];
            if (!s_.sharp_corner(corner) || !s_.leaves_corner(corner, d, 0)) return;
        }
        offer(distance, -d / distance, closest.p, t, false);
    }

    const Surface& s_;
    Vec3 c_;
    double radius_;
    MeetingSink& out_;
};

/// Contacts of any solid other than a ball.
class SolidOnTriangles
{
public:
    SolidOnTriangles(const Surface& s, const Solid& K, MeetingSink& out) : s_(s), K_(K), out_(out), size_(K.extent() + K.radius()) {}

    void meet(std::uint32_t index)
    {
        const Surface::Triangle& t = s_.triangles()[index];
        const Vec3& n = t.normal;
        const Vec3& origin = s_.point(t.corner[0]);
        const double limit = out_.limit();
        const bool in_front = dot(n, K_.center() - origin) > 0;
        if (in_front && dot(n, K_.support(-n) - origin) - K_.radius() < limit) corners_on_face(t);
        for (std::size_t i = 0; i < 3; ++i)
            if (const Surface::Edge& e = s_.edges()[t.edge[i]]; e.sharp && e.side[0] == index) meet_edge(e, t.edge[i]);
    }

private:
    void corners_on_face(const Surface::Triangle& t)
    {
        const Vec3& n = t.normal;
        const double beside = kBeside * size_;
        visit_corners(K_, -n,
                      [&](const Vec3& over, std::uint32_t number, const Vec3& p)
                      {
                          const double outside = dot(n, p - s_.point(t.corner[0])), gap = outside - K_.radius();
                          if (!(gap < out_.limit())) return;
                          for (std::size_t i = 0; i < 3; ++i)
                              if (dot(s_.inward(t, i), over - s_.point(t.corner[i])) < -beside) return;
                          if (outside < 0 && !lies_behind(p, -outside)) return;
                          const std::uint32_t feature = corner_feature(true, (t.patch & 0xffu) << 10 | (number & 0x3ffu));
                          const Vec3 on_surface = p - outside * n, point = on_surface + (0.5 * gap) * n;
                          const Pivot pivot = pivot_at_corner(Pivot::Of::A, K_, number, p, point);
                          out_.offer({gap, p - K_.radius() * n, on_surface, -n, feature, pivot});
                      });
    }

    /// Whether a corner of K, `depth` behind a face, is inside the material and entered through this face. It is not if another
    /// face is much nearer, whether the corner is in front of that face or behind it.
    bool lies_behind(const Vec3& p, double depth) const
    {
        const NearestPlace nearest(s_, p, depth);
        out_.note_triangles(nearest.visited());
        if (!nearest.found() || nearest.distance() >= depth * (1 - 1e-9)) return true;
        return nearest.behind() && depth <= std::max(kMuchNearer * nearest.distance(), kShallow * size_);
    }

    /// Whether both ends of the edge are beyond the same side of K by more than the limit, along one of K's own axes.
    bool beyond_limit(const Vec3& a, const Vec3& b) const
    {
        const double limit = out_.limit() + K_.radius();
        const double distance = limit + K_.extent();
        const Vec3 ab = b - a, ac = K_.center() - a;
        const double along = std::clamp(dot(ac, ab) / length_squared(ab), 0.0, 1.0);
        if (length_squared(ac - along * ab) > distance * distance) return true;
        const Vec3 la = K_.to_local(a), lb = K_.to_local(b);
        if (K_.core() == Core::Hull)
        {
            const auto& normals = K_.hull().loop_normals;
            std::uint32_t first = 0;
            for (std::size_t f = 0; f < normals.size(); ++f)
            {
                const double offset = dot(normals[f], K_.hull().vertices[K_.hull().loop[first]]) + limit;
                if (dot(normals[f], la) > offset && dot(normals[f], lb) > offset) return true;
                first = K_.hull().loop_end[f];
            }
            return false;
        }
        const Vec3 half = K_.core() == Core::Cylinder ? Vec3{K_.size().x, K_.size().x, K_.size().z} : K_.size();
        for (int k = 0; k < 3; ++k)
            if ((la[k] > half[k] + limit && lb[k] > half[k] + limit) || (la[k] < -half[k] - limit && lb[k] < -half[k] - limit)) return true;
        return false;
    }

    /// Whether direction m leads away from the surface: it must not point into either side, nor, at an end of the edge, along
    /// another edge.
    bool leads_away(const Surface::Edge& e, const Vec3& m, const Vec3& at) const
    {
        for (std::size_t i = 0; i < (e.border() ? 1u : 2u); ++i)
            if (dot(m, s_.inward(e, i)) > kAlong) return false;
        const double near = kAtEnd * size_;
        for (const std::uint32_t corner : {e.a, e.b})
            if (length_squared(at - s_.point(corner)) <= near * near) return s_.leaves_corner(corner, m, kAlong);
        return true;
    }

    void meet_edge(const Surface::Edge& e, std::uint32_t number)
    {
        const Vec3 &a = s_.point(e.a), &b = s_.point(e.b);
        for (std::size_t i = 0; i < (e.border() ? 1u : 2u); ++i)
        {
            const Vec3& n = s_.triangles()[e.side[i]].normal;
            if (dot(n, K_.support(-n) - a) - K_.radius() >= out_.limit()) return;
        }
        if (beyond_limit(a, b)) return;
        const Solid rod = Solid::rod(a, b);
        const Separation s = separation_of(K_, rod, out_.limit());
        if (!(s.gap < out_.limit()) || !leads_away(e, -s.normal, s.point_b)) return;
        ContactPoints contact_points(std::isfinite(out_.limit()) ? out_.limit() : 0);
        add_manifold(K_, rod, s, contact_points);
        const std::uint32_t feature = kNearestFeature | ((number & 0xffffu) << 2);
        std::uint32_t i = 0;
        for (const ContactPoint& t : contact_points.all())
        {
            const Vec3 half = (0.5 * t.depth) * t.normal;
            out_.offer({-t.depth, t.point + half, t.point - half, t.normal, feature | std::min(i++, 3u)});
        }
        if (i == 0) out_.offer({s.gap, s.point_a, s.point_b, s.normal, feature});
    }

    const Surface& s_;
    const Solid& K_;
    MeetingSink& out_;
    double size_;
};
}  // namespace

void meet_triangles(const Solid& K, const Collider& collider, MeetingSink& out)
{
    const Surface& surface = collider.triangles();
    if (K.core() == Core::Point) return BallOnTriangles(surface, K.pose().p, K.radius(), out).run();
    SolidOnTriangles pair(surface, K, out);
    const auto meet = [&](std::uint32_t t)
    {
        out.note_triangles(1);
        pair.meet(t);
    };
    if (!std::isfinite(out.limit()))
        return surface.visit_near(
            K.center(), [&] { return out.limit() + K.extent() + K.radius(); }, meet);
    Vec3 lower, upper;
    for (int k = 0; k < 3; ++k)
    {
        Vec3 axis;
        axis[k] = 1;
        const double by = K.radius() + out.limit();
        lower[k] = K.support(-axis)[k] - by, upper[k] = K.support(axis)[k] + by;
    }
    surface.visit_box(lower, upper, meet);
}

}  // namespace plab::detection
