#include "hull_pairs.h"

#include <cmath>
#include <optional>

#include "spread.h"

namespace plab::detection
{
namespace
{
/// A vertex of the Minkowski difference A - B with the two points that it comes from.
struct Support
{
    Vec3 v, a, b;
};

Vec3 furthest(const Hull& hull, const Pose& X, const Vec3& d)
{
    const Vec3 d_S = rotate_back(X.q, d);
    const Vec3* best = hull.vertices.data();
    double most = dot(d_S, *best);
    for (const Vec3& p : hull.vertices)
        if (const double m = dot(d_S, p); m > most) most = m, best = &p;
    return X * *best;
}

struct Exit
{
    Vec3 normal;
    double depth = 0;
    Vec3 point;
};

class PortalSearch
{
public:
    PortalSearch(const Hull& a, const Pose& X_a, const Hull& b, const Pose& X_b) : a_(a), b_(b), X_a_(X_a), X_b_(X_b) {}
    /// Where the ray from the centres' difference through the origin leaves A - B; nothing if it does so too early.
    std::optional<Exit> run();

private:
    Support support(const Vec3& d) const
    {
        const Vec3 a = furthest(a_, X_a_, d), b = furthest(b_, X_b_, -d);
        return {a - b, a, b};
    }
    bool find_portal();
    std::optional<Exit> refine();
    Vec3 point_on_portal(const Vec3& normal) const;

    static constexpr int kMaxIterations = 200;
    const Hull& a_;
    const Hull& b_;
    Pose X_a_, X_b_;
    Vec3 v0_;
    Support v1_, v2_, v3_;
};

std::optional<Exit> PortalSearch::run()
{
    v0_ = X_a_ * a_.center - X_b_ * b_.center;
    if (length_squared(v0_) == 0) v0_ = Vec3{0, 0, -1e-9} * length(a_.upper - a_.lower);
    v1_ = support(-v0_);
    if (dot(v1_.v, -v0_) <= 0) return {};
    const Vec3 d = cross(v1_.v, v0_);
    if (length(d) <= 1e-15 * length(v1_.v) * length(v0_))
    {
        // The vertex lies on the ray itself: the plane square to the ray supports A - B there.
        const Vec3 n = normalized(-v0_);
        return Exit{n, dot(n, v1_.v), (v1_.a + v1_.b) * 0.5};
    }
    v2_ = support(d);
    if (dot(v2_.v, d) <= 0) return {};
    return find_portal() ? refine() : std::nullopt;
}

/// A triangle v1 v2 v3 that the ray passes through.
bool PortalSearch::find_portal()
{
    Vec3 d = cross(v1_.v - v0_, v2_.v - v0_);
    if (dot(d, v0_) > 0) std::swap(v1_, v2_), d = -d;
    for (int i = 0; i < kMaxIterations; ++i)
    {
        v3_ = support(d);
        if (dot(v3_.v, d) <= 0) return false;
        if (dot(cross(v1_.v, v3_.v), v0_) < 0)
            v2_ = v3_;
        else if (dot(cross(v3_.v, v2_.v), v0_) < 0)
            v1_ = v3_;
        else
            return true;
        d = cross(v1_.v - v0_, v2_.v - v0_);
    }
    return false;
}

/// Moves the portal outwards until it is a face of A - B.
std::optional<Exit> PortalSearch::refine()
{
    const double tolerance = 1e-15 * (length(a_.upper - a_.lower) + length(b_.upper - b_.lower));
    Vec3 n;
    for (int i = 0; i < kMaxIterations; ++i)
    {
        const Vec3 across = cross(v2_.v - v1_.v, v3_.v - v1_.v);
        if (length_squared(across) == 0) break;
        n = normalized(across);
        const Support v4 = support(n);
        if (dot(v4.v, n) <= 0) return {};
        if (dot(v4.v - v3_.v, n) <= tolerance) break;
        const Vec3 side = cross(v4.v, v0_);
        if (dot(v1_.v, side) > 0)
            (dot(v2_.v, side) > 0 ? v1_ : v3_) = v4;
        else
            (dot(v3_.v, side) > 0 ? v2_ : v1_) = v4;
    }
    return Exit{n, dot(support(n).v, n), point_on_portal(n)};
}

/// Half way between the points of A and B that the ray meets on the portal.
Vec3 PortalSearch::point_on_portal(const Vec3& n) const
{
    const Vec3 x = v0_ * (dot(n, v1_.v) / dot(n, v0_));
    const double w1 = dot(n, cross(v2_.v - x, v3_.v - x));
    const double w2 = dot(n, cross(v3_.v - x, v1_.v - x));
    const double w3 = dot(n, cross(v1_.v - x, v2_.v - x));
    const double sum = w1 + w2 + w3;
    if (!(sum > 0)) return (v1_.a + v1_.b) * 0.5;
    return ((v1_.a + v1_.b) * w1 + (v2_.a + v2_.b) * w2 + (v3_.a + v3_.b) * w3) * (0.5 / sum);
}

/// The solid that points go into, in its own frame, and the direction in which they go.
struct Into
{
    const Hull& hull;
    Vec3 n_S;
    double tolerance;

    Into(const Hull& h, const Pose& X, const Vec3& n) : hull(h), n_S(rotate_back(X.q, n)), tolerance(1e-12 * length(h.upper - h.lower)) {}
    /// How far p_S has to go back along n to be out; 0 for a point outside.
    double depth(const Vec3& p_S) const
    {
        double d = HUGE_VAL;
        for (std::size_t f = 0; f < hull.faces.size(); ++f)
        {
            const double inside = hull.offsets[f] - dot(hull.normals[f], p_S);
            const double facing = -dot(hull.normals[f], n_S);
            if (inside < -tolerance) return 0;
            if (facing > 1e-9) d = std::fmin(d, inside / facing);
        }
        return d;
    }
};

/// Vertices of `from` inside `into`; n points from `from` to `into`, `sign` turns it to point from A to B.
void offer_vertices(const Hull& from, const Pose& X_from, const Hull& into, const Pose& X_into, const Vec3& n, std::uint32_t first_feature,
                    double sign, Spread& spread)
{
    const Into target(into, X_into, n);
    const double surface = dot(n, furthest(into, X_into, -n));
    for (std::uint32_t i = 0; i < from.vertices.size(); ++i)
    {
        const Vec3 p = X_from * from.vertices[i];
        if (dot(n, p) <= surface) continue;
        const double depth = target.depth(rotate_back(X_into.q, p - X_into.p));
        spread.offer({p - n * (0.5 * depth), n * sign, depth, first_feature + i % (kFeatures / 4)});
    }
}

/// The part [begin, end] of p + t d, t in [0, 1], that is inside; ends only on faces that stand along n count as cut.
struct Cut
{
    double begin = 0, end = 1;
    bool begin_counts = false, end_counts = false;
};

Cut cut_edge(const Into& into, const Vec3& p, const Vec3& d)
{
    constexpr double kAlong = 0.7;
    Cut cut;
    for (std::size_t f = 0; f < into.hull.faces.size() && cut.begin < cut.end; ++f)
    {
        const Vec3& m = into.hull.normals[f];
        const double inside = into.hull.offsets[f] - dot(m, p), rate = dot(m, d);
        const bool counts = std::fabs(dot(m, into.n_S)) < kAlong;
        if (rate == 0 && inside < -into.tolerance) return {1, 0, false, false};
        if (rate < 0 && inside / rate > cut.begin) cut.begin = inside / rate, cut.begin_counts = counts;
        if (rate > 0 && inside / rate < cut.end) cut.end = inside / rate, cut.end_counts = counts;
    }
    return cut;
}

/// Where edges of A cross edges of B: they enter B through a side of it.
void offer_edges(const Hull& a, const Pose& X_a, const Hull& b, const Pose& X_b, const Vec3& n, Spread& spread)
{
    const Into target(b, X_b, n);
    const double surface = dot(n, furthest(b, X_b, -n));
    for (std::uint32_t e = 0; e < a.edges.size(); ++e)
    {
        const Vec3 from = X_a * a.vertices[a.edges[e][0]], to = X_a * a.vertices[a.edges[e][1]];
        if (dot(n, from) <= surface && dot(n, to) <= surface) continue;
        const Vec3 p = rotate_back(X_b.q, from - X_b.p), d = rotate_back(X_b.q, to - from);
        const Cut cut = cut_edge(target, p, d);
        if (cut.begin >= cut.end) continue;
        const auto offer = [&](double t, std::uint32_t which)
        {
            const double depth = target.depth(p + t * d);
            const Vec3 point = from + t * (to - from);
            spread.offer({point - n * (0.5 * depth), n, depth, kFeatures / 2 + (2 * e + which) % (kFeatures / 4)});
        };
        if (cut.begin_counts) offer(cut.begin, 0);
        if (cut.end_counts) offer(cut.end, 1);
    }
}
}  // namespace

void hull_hull(const Hull& a, const Pose& X_a, const Hull& b, const Pose& X_b, Touches& out)
{
    const auto exit = PortalSearch(a, X_a, b, X_b).run();
    if (!exit || !(exit->depth > 0)) return;
    Spread spread(exit->normal);
    offer_vertices(a, X_a, b, X_b, exit->normal, 0, 1, spread);
    offer_vertices(b, X_b, a, X_a, -exit->normal, kFeatures / 4, -1, spread);
    offer_edges(a, X_a, b, X_b, exit->normal, spread);
    // Edge against edge: nothing is inside, or not as deep as the crossing.
    if (spread.deepest() < 0.5 * exit->depth) spread.offer({exit->point, exit->normal, exit->depth, kFeatures - 1});
    spread.take(out);
}

}  // namespace plab::detection
