#include "manifold.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "box_axes.h"
#include "pivots.h"
#include "rim_points.h"
#include "separation.h"
#include "spread.h"
#include "supporting_face.h"

namespace plab::detection
{
namespace
{
/// Cosines. A face takes part if it faces the other solid within 0.1 rad, or within 1.2 rad if the face of the other does so
/// within 0.1 rad.
constexpr double kParallelFaces = 0.995, kLeaning = 0.3;
/// As fractions of the solids' size. Corners that are outside by at most kOnBorder count as inside, as long as this changes no
/// depth by more than kDepthError: stacks of equal boxes thus keep their features. Points closer than kSamePoint are merged.
constexpr double kOnBorder = 1e-9, kDepthError = 1e-15, kSamePoint = 1e-6;
constexpr std::uint32_t kCornerMask = (1u << 18) - 1, kEdgeMask = (1u << 9) - 1;

bool is_corner_of_a(std::uint32_t feature) { return feature >> 18 == 0; }
bool is_corner_of_b(std::uint32_t feature) { return feature >> 18 == 1; }

/// Collects pairs of points of A and B that lie opposite one another along the normal.
class Collector
{
public:
    Collector(const Solid& A, const Solid& B, const Vec3& n, bool few, ContactPoints& out)
        : radius_a_(A.radius()),
          radius_b_(B.radius()),
          n_(n),
          out_(out),
          first_(out.all().size()),
          size_(A.extent() + B.extent()),
          A_(A),
          B_(B)
    {
        if (!few) spread_.emplace(n, out.margin(), kSamePoint * size_);
    }

    /// `fresh`: the caller knows that no earlier point can be in the same place.
    void offer(const Vec3& on_a, const Vec3& on_b, std::uint32_t feature, bool fresh = false)
    {
        const double gap = dot(n_, on_b - on_a) - (radius_a_ + radius_b_);
        if (!(gap < out_.margin() || gap < 0)) return;
        const Vec3 point = (on_a + on_b + (radius_a_ - radius_b_) * n_) * 0.5;
        deepest_ = std::max(deepest_, -gap);
        const ContactPoint found{point, n_, -gap, feature, pivot_at(feature, on_a, on_b, point)};
        if (spread_) return spread_->offer(found);
        if (fresh || !is_taken(point)) out_.add(found);
    }
    /// From now on, corners are offered that lie on edges: they pivot about no face.
    void offer_on_edges() { on_faces_ = false; }
    double deepest() const { return deepest_; }
    /// Tolerance at borders, m, for surfaces at an angle with this sine.
    double tolerance(double sine) const { return std::min(kOnBorder, kDepthError / sine) * size_; }
    void finish()
    {
        if (spread_) spread_->take(out_);
    }
    const Vec3& normal() const { return n_; }
    bool level_rims() const { return out_.level_rims(); }

private:
    Pivot pivot_at(std::uint32_t feature, const Vec3& on_a, const Vec3& on_b, const Vec3& point)
    {
        if (!on_faces_) return {};
        if (is_corner_of_a(feature)) return pivot_at_corner(Pivot::Of::A, A_, feature & kCornerMask, on_a, point);
        if (is_corner_of_b(feature)) return pivot_at_corner(Pivot::Of::B, B_, feature & kCornerMask, on_b, point);
        return feature == kNearestFeature ? pivot_at_nearest(on_a, on_b, point) : pivot_at_crossing(on_a, on_b, point);
    }
    /// An edge that crosses the border of a face.
    Pivot pivot_at_crossing(const Vec3& on_a, const Vec3& on_b, const Vec3& point)
    {
        if (!flat_b_) flat_b_ = is_flat_towards(B_, -n_);
        if (*flat_b_) return pivot_at_edge(Pivot::Of::A, A_, on_a, point);
        if (!flat_a_) flat_a_ = is_flat_towards(A_, n_);
        return *flat_a_ ? pivot_at_edge(Pivot::Of::B, B_, on_b, point) : Pivot{};
    }
    /// The closest points, where one of them is the furthest corner of a solid and the other is on a face.
    Pivot pivot_at_nearest(const Vec3& on_a, const Vec3& on_b, const Vec3& point) const
    {
        const auto is_furthest = [&](const Solid& solid, const Vec3& d, const Vec3& p)
        { return length_squared(solid.support(d) - p) < kSamePoint * kSamePoint * size_ * size_; };
        if (is_flat_towards(B_, -n_) && is_furthest(A_, n_, on_a)) return pivot_at_end(Pivot::Of::A, A_, n_, on_a, point);
        if (is_flat_towards(A_, n_) && is_furthest(B_, -n_, on_b)) return pivot_at_end(Pivot::Of::B, B_, -n_, on_b, point);
        return {};
    }
    bool is_taken(const Vec3& point) const
    {
        const double near = kSamePoint * size_;
        for (const ContactPoint& t : out_.all().subspan(first_))
            if (length_squared(t.point - point) < near * near) return true;
        return false;
    }

    double radius_a_, radius_b_;
    Vec3 n_;
    ContactPoints& out_;
    std::optional<Spread> spread_;  // used where there may be many points
    std::size_t first_;
    double size_;
    const Solid &A_, &B_;
    std::optional<bool> flat_a_, flat_b_;  // whether the solids have a face across the normal, once asked
    bool on_faces_ = true;
    double deepest_ = -HUGE_VAL;
};

/// The intersection of the line through p along n with the plane of a flat supporting face.
Vec3 dropped(const Vec3& p, const Vec3& n, const SupportingFace& onto)
{
    return p + n * (dot(onto.normal, onto.origin() - p) / dot(onto.normal, n));
}

/// Sine of the angle between X (a line or a flat face) and the flat face Y.
double lean_of(const SupportingFace& X, const SupportingFace& Y)
{
    if (X.kind == SupportingFace::Kind::Line) return std::fabs(dot(normalized(X.corners[1].p - X.corners[0].p), Y.normal));
    return length(cross(X.normal, Y.normal));
}

/// Clips the edges of X (a line or a face) against the flat face Y.
void lay_edges(const SupportingFace& X, const SupportingFace& Y, bool x_is_a, Collector& out)
{
    const Vec3& n = out.normal();
    const bool line = X.kind == SupportingFace::Kind::Line;
    const std::size_t count = X.corners.size(), edges = line ? 1 : count;
    const auto offer = [&](const Vec3& x, const Vec3& y, std::uint32_t feature)
    { x_is_a ? out.offer(x, y, feature) : out.offer(y, x, feature); };
    const auto edge_of_y = [&](int k)
    { return Y.kind == SupportingFace::Kind::Face ? Y.corners[static_cast<std::size_t>(k)].id : static_cast<std::uint32_t>(k); };

    const double tolerance = out.tolerance(lean_of(X, Y));
    Vec3 y0 = dropped(X.corners[0].p, n, Y);
    for (std::size_t i = 0; i < edges; ++i)
    {
        const FaceCorner &p = X.corners[i], &q = X.corners[(i + 1) % count];
        const Vec3 y1 = dropped(q.p, n, Y);
        const SupportingFace::Cut cut = Y.cut(y0, y1, tolerance);
        const auto crossing = [&](double t, int k)
        {
            const std::uint32_t f = x_is_a ? crossing_feature(p.id, edge_of_y(k)) : crossing_feature(edge_of_y(k), p.id);
            offer(p.p + t * (q.p - p.p), y0 + t * (y1 - y0), f);
        };
        if (!cut.empty())
        {
            if (cut.begin == 0) offer(p.p, y0, corner_feature(x_is_a, p.id));
            if (cut.begin > 0) crossing(cut.begin, cut.edge_begin);
            if (cut.end < 1) crossing(cut.end, cut.edge_end);
            if (cut.end == 1 && line) offer(q.p, y1, corner_feature(x_is_a, q.id));
        }
        y0 = y1;
    }
}

/// Projects the corners of X (a face, or the points that represent a rim) onto the flat face Y.
void lay_corners(const SupportingFace& X, const SupportingFace& Y, bool x_is_a, Collector& out)
{
    const Vec3& n = out.normal();
    const double tolerance = out.tolerance(lean_of(X, Y));
    const auto lay = [&](const Vec3& over, std::uint32_t id, const Vec3& p)
    {
        if (!Y.covers(dropped(over, n, Y), tolerance)) return;
        const Vec3 y = dropped(p, n, Y);
        const std::uint32_t f = corner_feature(x_is_a, id);
        x_is_a ? out.offer(p, y, f) : out.offer(y, p, f);
    };
    if (X.kind == SupportingFace::Kind::Face)
        for (const FaceCorner& c : X.corners) lay(c.p, c.id, c.p);
    if (X.kind != SupportingFace::Kind::Disc) return;
    for (const bool upper : {X.upper, !X.upper})
    {
        const RimPoints rim = rim_points(*X.solid, upper, x_is_a ? n : -n, out.level_rims());
        for (std::uint32_t i = rim.count; i-- > 0;) lay(rim.p[i], rim.id[i] + (upper ? 8 : 0), rim.touching(i));
    }
}

/// The planes through the edges of a face, and the plane of the face along n, as four numbers each.
struct FaceFrame
{
    Vec3 along;  ///< the distance from p to the face along n is level - along . p
    double level = 0;
    std::array<double, kMostCorners> limit;  ///< p is inside edge k if corners[k].inward . p >= limit[k]

    FaceFrame(const SupportingFace& face, const Vec3& n) : along(face.normal / dot(face.normal, n)), level(dot(along, face.corners[0].p))
    {
        for (std::size_t k = 0; k < face.corners.size(); ++k) limit[k] = dot(face.corners[k].inward, face.corners[k].p);
    }
};

/// Face on face: equivalent to lay_edges(X on Y) and lay_corners(Y on X), but projects and measures each corner once.
void lay_faces(const SupportingFace& X, const SupportingFace& Y, Collector& out)
{
    const Vec3& n = out.normal();
    const FaceFrame onto_y(Y, n), onto_x(X, n);
    const double tolerance = out.tolerance(lean_of(X, Y));
    const std::size_t nx = X.corners.size(), ny = Y.corners.size();
    std::array<double, kMostCorners * kMostCorners> inside;  // of Y's edge k, corner i of X: [i * ny + k]
    std::array<std::uint32_t, kMostCorners> outside;         // the edges that a corner of X is outside of, as bits
    static_assert(kMostCorners <= 32);
    for (std::size_t i = 0; i < nx; ++i)
    {
        const Vec3& p = X.corners[i].p;
        const Vec3 y = p + n * (onto_y.level - dot(onto_y.along, p));
        outside[i] = 0;
        for (std::size_t k = 0; k < ny; ++k)
        {
            const double depth = dot(Y.corners[k].inward, y) - onto_y.limit[k];
            inside[i * ny + k] = depth;
            outside[i] |= (depth < -tolerance ? 1u : 0u) << k;
        }
    }
    for (std::size_t i = 0; i < nx; ++i)
    {
        const std::size_t j = i + 1 < nx ? i + 1 : 0;
        if ((outside[i] & outside[j]) != 0) continue;
        const FaceCorner &p = X.corners[i], &q = X.corners[j];
        SupportingFace::Cut cut;
        if ((outside[i] | outside[j]) != 0) cut = cut_by({&inside[i * ny], ny}, {&inside[j * ny], ny}, tolerance);
        if (cut.empty()) continue;
        const auto offer = [&](const Vec3& x, std::uint32_t feature)
        { out.offer(x, x + n * (onto_y.level - dot(onto_y.along, x)), feature, true); };
        if (cut.begin == 0) offer(p.p, corner_feature(true, p.id));
        if (cut.begin > 0)
            offer(p.p + cut.begin * (q.p - p.p), crossing_feature(p.id, Y.corners[static_cast<std::size_t>(cut.edge_begin)].id));
        if (cut.end < 1) offer(p.p + cut.end * (q.p - p.p), crossing_feature(p.id, Y.corners[static_cast<std::size_t>(cut.edge_end)].id));
    }
    for (const FaceCorner& c : Y.corners)
    {
        const Vec3 x = c.p + n * (onto_x.level - dot(onto_x.along, c.p));
        bool covered = true;
        for (std::size_t k = 0; k < nx && covered; ++k) covered = dot(X.corners[k].inward, x) - onto_x.limit[k] >= -tolerance;
        if (covered) out.offer(x, c.p, corner_feature(false, c.id));
    }
}

/// The crossings of two rims, seen along the normal. The rims are treated as circles, which is right when the ends are parallel.
void lay_rims(const SupportingFace& X, const SupportingFace& Y, Collector& out)
{
    if (-dot(X.normal, Y.normal) < kParallelFaces) return;
    const Vec3& n = out.normal();
    const Vec3 center = X.origin(), across = dropped(Y.origin(), n, X) - center;
    const double r = X.solid->size().x, s = Y.solid->size().x, d = length(across);
    if (!(d > 0) || d >= r + s || d <= std::fabs(r - s)) return;
    const double along = (d * d + r * r - s * s) / (2 * d), aside = std::sqrt(std::fmax(r * r - along * along, 0));
    const Vec3 u = across / d, v = normalized(cross(n, u));
    for (const double side : {-1.0, 1.0})
    {
        const Vec3 p = center + along * u + side * aside * v;
        out.offer(p, dropped(p, n, Y), crossing_feature(side < 0 ? 0 : 1, side < 0 ? 0 : 1));
    }
}

/// Two nearly parallel edges: the ends of the part that they share.
void lay_lines(const SupportingFace& X, const SupportingFace& Y, Collector& out)
{
    const Vec3 a = X.corners[0].p, u = X.corners[1].p - a, b = Y.corners[0].p, v = Y.corners[1].p - b;
    const double uu = length_squared(u), vv = length_squared(v);
    if (length_squared(cross(u, v)) > (1 - kParallelFaces) * 2 * uu * vv) return;
    const auto lay = [&](const SupportingFace& P, const Vec3& q, const Vec3& w, double ww, bool p_is_a)
    {
        for (const FaceCorner& c : P.corners)
        {
            const double t = dot(c.p - q, w) / ww;
            if (t < -kOnBorder || t > 1 + kOnBorder) continue;
            const std::uint32_t f = corner_feature(p_is_a, c.id);
            p_is_a ? out.offer(c.p, q + t * w, f) : out.offer(q + t * w, c.p, f);
        }
    };
    out.offer_on_edges();
    lay(X, b, v, vv, true), lay(Y, a, u, uu, false);
}

void overlay_faces(const SupportingFace& X, const SupportingFace& Y, Collector& out)
{
    using Kind = SupportingFace::Kind;
    if (X.kind == Kind::Line && Y.kind == Kind::Line) return lay_lines(X, Y, out);
    if (X.kind == Kind::Corner || Y.kind == Kind::Corner || !(X.flat() || Y.flat())) return;
    if (X.kind == Kind::Face && Y.kind == Kind::Face) return lay_faces(X, Y, out);
    if (X.kind == Kind::Disc && Y.kind == Kind::Disc) lay_rims(X, Y, out);
    if (X.kind != Kind::Disc && Y.flat()) lay_edges(X, Y, true, out);
    if (X.kind == Kind::Disc && Y.kind != Kind::Disc) lay_edges(Y, X, false, out);
    if (X.kind == Kind::Disc && Y.flat()) lay_corners(X, Y, true, out);
    if (Y.kind == Kind::Disc && X.flat()) lay_corners(Y, X, false, out);
    if (Y.kind == Kind::Line && X.kind == Kind::Face) lay_edges(Y, X, false, out);
}

/// The closest points of two box edges whose cross product is the normal.
Separation edge_pair(const Solid& A, const Solid& B, const BoxAxis& axis)
{
    const Vec3 a = A.support(axis.normal), b = B.support(-axis.normal);
    const Vec3 u = A.axis(axis.edge_a), v = B.axis(axis.edge_b), n = cross(u, v), r = b - a;
    const double nn = length_squared(n);
    return {axis.gap, a + u * (dot(cross(r, v), n) / nn), b + v * (dot(cross(r, u), n) / nn), axis.normal};
}
}  // namespace

std::uint32_t corner_feature(bool of_a, std::uint32_t corner) { return ((of_a ? 0u : 1u) << 18) | (corner & kCornerMask); }
std::uint32_t crossing_feature(std::uint32_t a, std::uint32_t b) { return (2u << 18) | ((a & kEdgeMask) << 9) | (b & kEdgeMask); }

std::uint32_t mirrored_feature(std::uint32_t f)
{
    switch (f >> 18)
    {
        case 0:
            return f | (1u << 18);
        case 1:
            return f & kCornerMask;
        case 2:
            return crossing_feature(f & kEdgeMask, (f >> 9) & kEdgeMask);
        default:
            return f;
    }
}

void add_manifold(const Solid& A, const Solid& B, const Separation& s, ContactPoints& out)
{
    if (!(s.gap < out.margin() || s.gap < 0)) return;
    std::array<FaceCorner, kMostCorners> room_a, room_b;
    SupportingFace X = supporting_face(A, s.normal, kParallelFaces, room_a), Y = supporting_face(B, -s.normal, kParallelFaces, room_b);
    if (X.flat() && !Y.flat()) Y = supporting_face(B, -s.normal, kLeaning, room_b, true);
    if (Y.flat() && !X.flat()) X = supporting_face(A, s.normal, kLeaning, room_a, true);
    const bool few =
        X.corners.size() + Y.corners.size() <= 8 && X.kind != SupportingFace::Kind::Disc && Y.kind != SupportingFace::Kind::Disc;
    Collector collector(A, B, s.normal, few, out);
    overlay_faces(X, Y, collector);
    // Corner on corner, or crossing edges: no other point is as near as the closest points.
    const double enough = std::max(1e-3 * std::fabs(s.gap), 1e-12 * (A.extent() + B.extent()));
    if (collector.deepest() < -s.gap - enough)
        collector.offer(s.point_a - A.radius() * s.normal, s.point_b + B.radius() * s.normal, kNearestFeature);
    collector.finish();
}

void box_box(const Solid& A, const Solid& B, ContactPoints& out)
{
    const Vec3 origin = A.pose().p;
    const BoxAxis axis = find_box_axis(A.size(), A.axes(), origin, B.size(), B.axes(), B.pose().p, out.margin());
    if (!(axis.gap < out.margin() || axis.gap < 0)) return;
    std::array<FaceCorner, 4> room_a, room_b;
    const SupportingFace X = box_face(A, axis.normal, room_a), Y = box_face(B, -axis.normal, room_b);
    const bool parallel = dot(X.normal, axis.normal) >= kParallelFaces || dot(Y.normal, axis.normal) <= -kParallelFaces;
    if (axis.edge_a >= 0 && !parallel) return add_manifold(A, B, edge_pair(A, B, axis), out);
    Collector collector(A, B, axis.normal, true, out);
    overlay_faces(X, Y, collector);
    const bool reached = collector.deepest() >= -axis.gap - std::max(1e-3 * std::fabs(axis.gap), 1e-12 * (A.extent() + B.extent()));
    if (reached) return;
    if (axis.edge_a >= 0)
    {
        const Separation s = edge_pair(A, B, axis);
        return collector.offer(s.point_a, s.point_b, kNearestFeature);
    }
    // Corner beside corner: the distance is larger than the gap along any of the axes.
    if (axis.gap >= 0 && collector.deepest() == -HUGE_VAL) add_manifold(A, B, separation_of(A, B), out);
}

}  // namespace plab::detection
