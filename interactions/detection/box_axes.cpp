#include "box_axes.h"

#include <array>
#include <cmath>

namespace plab::detection
{
namespace
{
Vec3 column(const Mat3& R, int k) { return {R(0, k), R(1, k), R(2, k)}; }

/// Fraction of the boxes' size by which an axis must be better than the earlier ones, so that rounding does not decide between
/// equal axes.
constexpr double kPreference = 4e-15;
/// Edges with a smaller sine count as parallel: a face normal then serves as well.
constexpr double kParallel = 1e-7;

using Triple = std::array<double, 3>;

/// The inputs of the 15 tests, in plain arrays: Vec3 selects its component by a branch.
struct Boxes
{
    Triple a, b, t;              ///< half extents; p_b - p_a in A's frame
    std::array<Triple, 3> C, F;  ///< b's axes in A's frame, and their absolute values
};

/// The best axis so far, by number: 0 to 2 for A's faces, 3 to 5 for B's faces, 6 + 3 i + j for the cross product of edges i and
/// j.
struct Best
{
    int axis = 0;
    double gap = -HUGE_VAL;
    bool backwards = false;  ///< whether it points from B to A

    void offer(int which, double along, double radii, double preference)
    {
        const double candidate = std::fabs(along) - radii;
        if (candidate > gap + preference) axis = which, gap = candidate, backwards = along < 0;
    }
};

void try_faces(const Boxes& x, double preference, Best& best)
{
    for (std::size_t i = 0; i < 3; ++i)
        best.offer(static_cast<int>(i), x.t[i], x.a[i] + (x.F[i][0] * x.b[0] + x.F[i][1] * x.b[1] + x.F[i][2] * x.b[2]), preference);
    for (std::size_t j = 0; j < 3; ++j)
    {
        const double along = x.t[0] * x.C[0][j] + x.t[1] * x.C[1][j] + x.t[2] * x.C[2][j];
        best.offer(static_cast<int>(3 + j), along, x.b[j] + (x.F[0][j] * x.a[0] + x.F[1][j] * x.a[1] + x.F[2][j] * x.a[2]), preference);
    }
}

/// The axis e_i x f_j in A's frame; its component along e_i is 0. Its error is a rounding error divided by the sine. The compiler knows
/// the numbers, so that it computes no index.
template <std::size_t i, std::size_t j>
void try_edge(const Boxes& x, double preference, Best& best)
{
    constexpr std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const double u = -x.C[i2][j], v = x.C[i1][j];  // components along e_i1, e_i2
    const double square = u * u + v * v;
    const double along = x.t[i1] * u + x.t[i2] * v;
    const double radii = x.a[i1] * x.F[i2][j] + x.a[i2] * x.F[i1][j] + x.b[j1] * x.F[i][j2] + x.b[j2] * x.F[i][j1];
    // Most axes can be rejected before the square root is taken.
    const double rough = std::fabs(along) - radii;
    if (square < kParallel * kParallel || (rough < 0 && best.gap < 0 && rough * rough > best.gap * best.gap * square)) return;
    const double sine = std::sqrt(square);
    best.offer(static_cast<int>(6 + 3 * i + j), along / sine, radii / sine, preference / sine);
}

template <std::size_t i>
void try_edges(const Boxes& x, double preference, double margin, Best& best)
{
    if (best.gap > margin) return;
    try_edge<i, 0>(x, preference, best), try_edge<i, 1>(x, preference, best), try_edge<i, 2>(x, preference, best);
}

Boxes boxes_of(const Vec3& half_a, const Mat3& R_a, const Vec3& half_b, const Mat3& R_b, const Vec3& between)
{
    Boxes x;
    const Vec3 t = transposed_times(R_a, between);
    x.a = {half_a.x, half_a.y, half_a.z}, x.b = {half_b.x, half_b.y, half_b.z}, x.t = {t.x, t.y, t.z};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
        {
            x.C[i][j] = R_a.m[0][i] * R_b.m[0][j] + R_a.m[1][i] * R_b.m[1][j] + R_a.m[2][i] * R_b.m[2][j];
            x.F[i][j] = std::fabs(x.C[i][j]);
        }
    return x;
}

BoxAxis finished(const Best& best, const Boxes& x, const Mat3& R_a, const Mat3& R_b)
{
    BoxAxis out;
    out.gap = best.gap;
    const double sign = best.backwards ? -1 : 1;
    if (best.axis < 6)
    {
        out.normal = (best.axis < 3 ? column(R_a, best.axis) : column(R_b, best.axis - 3)) * sign;
        return out;
    }
    out.edge_a = (best.axis - 6) / 3, out.edge_b = (best.axis - 6) % 3;
    const int i1 = (out.edge_a + 1) % 3, i2 = (out.edge_a + 2) % 3;
    const auto j = static_cast<std::size_t>(out.edge_b);
    const double u = -x.C[static_cast<std::size_t>(i2)][j], v = x.C[static_cast<std::size_t>(i1)][j];
    out.normal = (column(R_a, i1) * u + column(R_a, i2) * v) * (sign / std::sqrt(u * u + v * v));
    return out;
}
}  // namespace

BoxAxis find_box_axis(const Vec3& half_a, const Mat3& R_a, const Vec3& p_a, const Vec3& half_b, const Mat3& R_b, const Vec3& p_b,
                      double margin)
{
    const Boxes x = boxes_of(half_a, R_a, half_b, R_b, p_b - p_a);
    const double preference = kPreference * (half_a.x + half_a.y + half_a.z + half_b.x + half_b.y + half_b.z);
    Best best;
    try_faces(x, preference, best);
    try_edges<0>(x, preference, margin, best), try_edges<1>(x, preference, margin, best), try_edges<2>(x, preference, margin, best);
    return finished(best, x, R_a, R_b);
}

}  // namespace plab::detection
