#include "gjk.h"

#include "plab/eigen.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace plab::detection
{
namespace
{
constexpr double kGjkEpsilon = 2.3e-16;
constexpr int kMostRounds = 96;

/// A point of a simplex, as a convex combination of some of its corners.
struct Part
{
    Vec3 p;
    double squared = HUGE_VAL;
    std::array<std::uint8_t, 3> corner{};
    std::array<double, 3> weight{};
    std::size_t count = 0;
};
using Corners = std::array<Support, 4>;

void offer(Part& best, const Vec3& p, std::size_t count, const std::array<std::uint8_t, 3>& corner, const std::array<double, 3>& weight)
{
    const double squared = length_squared(p);
    if (squared < best.squared) best = {p, squared, corner, weight, count};
}

void try_segment(const Corners& s, std::uint8_t i, std::uint8_t j, Part& best)
{
    const Vec3 e = s[j].w - s[i].w;
    const double along = -dot(s[i].w, e), all = length_squared(e);
    const double t = along / all;
    if (along > 0 && along < all) return offer(best, s[i].w + t * e, 2, {i, j}, {1 - t, t});
    const std::uint8_t end = along > 0 ? j : i;
    offer(best, s[end].w, 1, {end}, {1});
}

void try_triangle(const Corners& s, std::uint8_t i, std::uint8_t j, std::uint8_t k, Part& best)
{
    const Vec3 e1 = s[j].w - s[i].w, e2 = s[k].w - s[i].w;
    const Vec3 n = cross(e1, e2);
    const double nn = length_squared(n);
    if (nn > 1e-28 * length_squared(e1) * length_squared(e2))
    {
        const auto share = [&](std::uint8_t p, std::uint8_t q) { return dot(cross(n, s[q].w - s[p].w), -s[p].w) / nn; };
        const double of_i = share(j, k), of_j = share(k, i), of_k = share(i, j);
        if (of_i >= 0 && of_j >= 0 && of_k >= 0) return offer(best, n * (dot(n, s[i].w) / nn), 3, {i, j, k}, {of_i, of_j, of_k});
    }
    try_segment(s, i, j, best), try_segment(s, j, k, best), try_segment(s, k, i, best);
}

/// Returns true if the origin is inside; otherwise offers the nearest point of the surface.
bool try_tetrahedron(const Corners& s, Part& best)
{
    constexpr std::array<std::array<std::uint8_t, 4>, 4> kFaces{{{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}}};
    bool inside = true;
    for (const auto& [i, j, k, opposite] : kFaces)
    {
        const Vec3 n = cross(s[j].w - s[i].w, s[k].w - s[i].w);
        const Vec3 across = s[opposite].w - s[i].w;
        const double volume = dot(n, across), here = -dot(n, s[i].w);
        const bool flat = std::fabs(volume) <= 1e-13 * length(n) * length(across);
        if (!flat && (here > 0) == (volume > 0) && here != 0) continue;
        inside = false;
        try_triangle(s, i, j, k, best);
    }
    return inside;
}

/// Reduces the simplex to the vertices that span its point nearest to the origin.
void reduce(Simplex& s)
{
    Part best;
    if (s.count == 1) offer(best, s.at[0].w, 1, {0}, {1});
    if (s.count == 2) try_segment(s.at, 0, 1, best);
    if (s.count == 3) try_triangle(s.at, 0, 1, 2, best);
    if (s.count == 4 && try_tetrahedron(s.at, best))
    {
        s.encloses = true, s.nearest = {};
        return;
    }
    const Corners before = s.at;
    s.count = best.count, s.nearest = best.p, s.nearest_a = {};
    for (std::size_t i = 0; i < best.count; ++i)
    {
        s.at[i] = before[best.corner[i]];
        s.nearest_a += best.weight[i] * s.at[i].a;
    }
}

bool holds(const Simplex& s, const Vec3& w)
{
    return std::any_of(s.at.begin(), s.at.begin() + static_cast<std::ptrdiff_t>(s.count), [&](const Support& k) { return k.w == w; });
}

/// Solves M x = r with full pivoting; components of x in singular directions are 0.
Vec3 solve_where_regular(const Mat3& M, const Vec3& r)
{
    constexpr double kLeastPivot = 1e-9;
    Eigen::FullPivLU<Eigen::Matrix3d> factors(as_eigen(M));
    if (!(factors.maxPivot() > kLeastPivot)) return {};
    factors.setThreshold(kLeastPivot / factors.maxPivot());  // Eigen's threshold is relative
    return from_eigen(factors.solve(as_eigen(r)).eval());
}

struct ClosestPoints
{
    ClosestPoint a, b;
    double squared = 0;  ///< distance squared
};

class Polish
{
public:
    Polish(const Solid& A, const Solid& B, const Simplex& s) : A_(A), B_(B), scale_(A.extent() + B.extent() + length(s.nearest))
    {
        const auto collect = [&](Facelet& f, Vec3 Support::*side)
        {
            for (std::size_t i = 0; i < s.count && f.count < 3; ++i)
            {
                const Vec3& p = s.at[i].*side;
                const auto end = f.corner.begin() + f.count;
                if (std::find(f.corner.begin(), end, p) == end) f.corner[static_cast<std::size_t>(f.count++)] = p;
            }
        };
        collect(face_a_, &Support::a), collect(face_b_, &Support::b);
    }
    ClosestPoints from(const Vec3& p_start) const;
    Vec3 normal_of(const ClosestPoints& closest_points) const;

private:
    ClosestPoints closest_points_of(const Vec3& p) const
    {
        ClosestPoints out;
        out.b = B_.closest_point(p, face_b_);
        out.a = A_.closest_point(out.b.p, face_a_);
        out.squared = length_squared(out.b.p - out.a.p);
        return out;
    }
    const Solid& A_;
    const Solid& B_;
    double scale_;
    Facelet face_a_, face_b_;
};

/// Alternating projections never increase the distance, but may converge slowly; a Newton step is taken where it does at least
/// as well.
ClosestPoints Polish::from(const Vec3& p_start) const
{
    constexpr int kMost = 24;
    Vec3 p = p_start;
    ClosestPoints now = closest_points_of(p);
    for (int i = 0; i < kMost; ++i)
    {
        const Vec3 step = now.a.p - p;
        if (length(step) <= 2 * kGjkEpsilon * scale_) break;
        const Vec3 newton = solve_where_regular(Mat3::identity() - now.a.J * now.b.J, step);
        const ClosestPoints ahead = closest_points_of(p + newton), plain = closest_points_of(now.a.p);
        const bool better = is_finite(newton) && ahead.squared <= plain.squared;
        p = better ? p + newton : now.a.p;
        if (better && length(newton) <= 2 * kGjkEpsilon * scale_) break;
        now = better ? ahead : plain;
    }
    return now;
}

Vec3 Polish::normal_of(const ClosestPoints& f) const
{
    const Vec3 across = f.b.p - f.a.p;
    if (f.a.flat == 2) return f.a.axis;
    if (f.b.flat == 2) return -f.b.axis;
    if (f.a.flat == 1 && f.b.flat == 1)
    {
        const Vec3 n = cross(f.a.axis, f.b.axis);
        const double sine = length(n);
        if (sine > 1e-3) return n * ((dot(n, across) < 0 ? -1 : 1) / sine);
    }
    return normalized(across);
}
}  // namespace

Support support_of(const Solid& A, const Solid& B, const Vec3& d)
{
    const Vec3 a = A.support(d), b = B.support(-d);
    return {a - b, a, b};
}

GjkResult gjk(const Solid& A, const Solid& B, double tolerance)
{
    GjkResult out;
    Simplex& s = out.simplex;
    const double scale = A.extent() + B.extent();
    Vec3 start = B.center() - A.center();
    if (length_squared(start) == 0) start = {1, 0, 0};
    s.at[0] = support_of(A, B, start), s.count = 1, s.nearest = s.at[0].w, s.nearest_a = s.at[0].a;
    for (int i = 0; i < kMostRounds; ++i)
    {
        const double distance = length(s.nearest);
        if (distance <= 4 * kGjkEpsilon * scale)
        {
            s.encloses = true;
            return out;
        }
        const Support next = support_of(A, B, -s.nearest);
        const double gain = distance - dot(s.nearest, next.w) / distance;
        if (gain <= std::max(tolerance, kGjkEpsilon * distance) || holds(s, next.w)) return out;
        const Simplex before = s;
        s.at[s.count++] = next;
        reduce(s);
        if (s.encloses) return out;
        if (!(length_squared(s.nearest) < distance * distance))
        {
            s = before;
            return out;
        }
    }
    out.converged = false;
    return out;
}

NearestPair nearest_pair(const Solid& A, const Solid& B)
{
    const double scale = A.extent() + B.extent();
    const bool curved = A.curved() || B.curved();
    const GjkResult found = gjk(A, B, (curved ? 1e-7 : 2 * kGjkEpsilon) * scale);
    NearestPair out;
    if (found.simplex.encloses) return out;

    const Polish polish(A, B, found.simplex);
    const ClosestPoints closest_points = polish.from(found.simplex.nearest_a);
    out.a = closest_points.a.p, out.b = closest_points.b.p;
    const double distance = std::sqrt(closest_points.squared);
    if (closest_points.a.flat == 3 || closest_points.b.flat == 3 || distance <= 4 * kGjkEpsilon * scale) return out;
    out.normal = polish.normal_of(closest_points);
    out.gap = dot(out.normal, out.b - out.a);
    out.apart = out.gap > 0;
    return out;
}

}  // namespace plab::detection
