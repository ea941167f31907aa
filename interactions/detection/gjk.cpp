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
constexpr int kMostSteps = 24;  ///< of Newton's method

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

/// The point of the first corners that is nearest to the origin; true if these enclose the origin.
bool find_nearest(const Corners& corners, std::size_t count, Part& best)
{
    if (count == 1) offer(best, corners[0].w, 1, {0}, {1});
    if (count == 2) try_segment(corners, 0, 1, best);
    if (count == 3) try_triangle(corners, 0, 1, 2, best);
    return count == 4 && try_tetrahedron(corners, best);
}

/// Reduces the simplex to the corners on which its nearest point depends.
void reduce_to(const Part& part, Simplex& s)
{
    std::array<Support, 3> kept;
    s.nearest = part.p, s.nearest_a = {};
    for (std::size_t i = 0; i < part.count; ++i)
    {
        kept[i] = s.at[part.corner[i]];
        s.nearest_a += part.weight[i] * kept[i].a;
    }
    std::copy_n(kept.begin(), part.count, s.at.begin());
    s.count = part.count;
}

bool holds(const Simplex& s, const Vec3& w)
{
    return std::any_of(s.at.begin(), s.at.begin() + static_cast<std::ptrdiff_t>(s.count), [&](const Support& k) { return k.w == w; });
}

/// Solves M x = r, where no number of M is larger than 1 by much; components of x in singular directions are 0.
Vec3 solve_where_regular(const Mat3& M, const Vec3& r)
{
    constexpr double kRegular = 1e-3, kLeastPivot = 1e-9;
    Eigen::Matrix3d inverse;
    bool regular = false;
    as_eigen(M).computeInverseWithCheck(inverse, regular, kRegular);  // a tenth of the cost of the factorisation
    if (regular) return from_eigen((inverse * as_eigen(r)).eval());
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
    ClosestPoints from(const Vec3& p_start, int most_steps) const;
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

/// Alternating projections never increase the distance, but may converge slowly; a Newton step is taken where it brings both points
/// clearly nearer to a fixed point, or at least as near to one another as a projection does.
ClosestPoints Polish::from(const Vec3& p_start, int most_steps) const
{
    Vec3 p = p_start;
    ClosestPoints now = closest_points_of(p);
    for (int i = 0; i < most_steps; ++i)
    {
        const Vec3 step = now.a.p - p;
        const double residual = length(step);
        if (residual <= 2 * kGjkEpsilon * scale_) break;
        const Vec3 newton = solve_where_regular(Mat3::identity() - now.a.J * now.b.J, step), next = p + newton;
        const ClosestPoints ahead = closest_points_of(next);
        bool better = ahead.squared <= now.squared && length(ahead.a.p - next) <= 0.25 * residual;
        if (!better)
        {
            const ClosestPoints plain = closest_points_of(now.a.p);
            better = is_finite(newton) && ahead.squared <= plain.squared;
            if (!better)
            {
                p = now.a.p, now = plain;
                continue;
            }
        }
        p = next;
        if (length(newton) <= 2 * kGjkEpsilon * scale_) break;
        now = ahead;
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

/// The closest points to which Newton's method leads from a point of A.
NearestPair polished(const Solid& A, const Solid& B, const Simplex& simplex, const Vec3& from, int most_steps)
{
    const double scale = A.extent() + B.extent();
    const Polish polish(A, B, simplex);
    const ClosestPoints closest_points = polish.from(from, most_steps);
    NearestPair out;
    out.a = closest_points.a.p, out.b = closest_points.b.p;
    const double distance = std::sqrt(closest_points.squared);
    if (closest_points.a.flat == 3 || closest_points.b.flat == 3 || distance <= 4 * kGjkEpsilon * scale) return out;
    out.normal = polish.normal_of(closest_points);
    out.gap = dot(out.normal, out.b - out.a);
    out.apart = out.gap > 0;
    const double proven = -dot(out.normal, support_of(A, B, out.normal).w);
    out.proven = out.gap - proven <= 1e-14 * (scale + out.gap);
    return out;
}
}  // namespace

Support support_of(const Solid& A, const Solid& B, const Vec3& d)
{
    const Vec3 a = A.support(d), b = B.support(-d);
    return {a - b, a, b};
}

Simplex Simplex::with_b_moved(const Vec3& by) const
{
    Simplex out = *this;
    for (std::size_t i = 0; i < count; ++i) out.at[i].w -= by, out.at[i].b += by;
    out.encloses = false, out.least = 0;
    return out;
}

void gjk(const Solid& A, const Solid& B, const GjkGoal& goal, Simplex& s)
{
    const double scale = A.extent() + B.extent();
    if (s.count == 0)
    {
        Vec3 start = B.center() - A.center();
        if (length_squared(start) == 0) start = {1, 0, 0};
        s.at[0] = support_of(A, B, start), s.count = 1;
    }
    Part nearest;
    s.encloses = find_nearest(s.at, s.count, nearest);
    if (s.encloses) return;
    reduce_to(nearest, s);
    for (int i = 0; i < kMostRounds; ++i)
    {
        const double distance = length(s.nearest);
        if (distance <= 4 * kGjkEpsilon * scale)
        {
            s.encloses = true;
            return;
        }
        const Support next = support_of(A, B, -s.nearest);
        const double proven = dot(s.nearest, next.w) / distance, gain = distance - proven;
        s.least = std::max(s.least, proven);
        if (s.least > goal.beyond || gain <= std::max(goal.tolerance, kGjkEpsilon * distance) || holds(s, next.w)) return;
        if (s.least > 0 && gain <= goal.tolerance_apart) return;
        s.at[s.count] = next;
        nearest = {};
        s.encloses = find_nearest(s.at, s.count + 1, nearest);
        if (s.encloses)
        {
            ++s.count;
            return;
        }
        if (!(nearest.squared < distance * distance)) return;
        reduce_to(nearest, s);
    }
}

NearestPair nearest_pair(const Solid& A, const Solid& B, double beyond, Simplex& simplex, const Vec3* guess)
{
    if (guess)
        if (const NearestPair near = polished(A, B, simplex, *guess, kMostSteps); near.apart && near.proven) return near;
    // Newton's method needs a start that is near enough, which depends on the shapes; the last tolerance is small enough for all.
    constexpr std::array<double, 3> kRough{1e-3, 1e-5, 1e-7};
    const double scale = A.extent() + B.extent();
    const bool curved = A.curved() || B.curved();
    GjkGoal goal{(curved ? kRough.back() : 2 * kGjkEpsilon) * scale, 0, beyond};
    NearestPair out;
    for (const double rough : kRough)
    {
        goal.tolerance_apart = curved ? rough * scale : 0;
        gjk(A, B, goal, simplex);
        if (simplex.encloses) return {};
        if (simplex.least > beyond)
        {
            out = {};
            out.apart = out.beyond = true, out.gap = simplex.least;
            return out;
        }
        out = polished(A, B, simplex, simplex.nearest_a, kMostSteps);
        if (out.proven || !curved) break;
    }
    return out;
}

NearestPair nearest_pair_near(const Solid& A, const Solid& B, const Simplex& simplex, const Vec3& guess)
{
    return polished(A, B, simplex, guess, 1);
}

}  // namespace plab::detection
