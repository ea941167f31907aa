#include "world/principal_axes.h"

#include <array>
#include <cmath>
#include <utility>

namespace plab::world
{
namespace
{

using Columns = std::array<Vec3, 3>;

Vec3 axis(int i) { return {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}; }

/// The quaternion of a rotation given by its columns (Shepperd's method).
Quat quaternion_of(const Columns& c)
{
    const double xx = c[0].x, yy = c[1].y, zz = c[2].z;
    if (xx + yy + zz > 0) return normalized(Quat{1 + xx + yy + zz, c[1].z - c[2].y, c[2].x - c[0].z, c[0].y - c[1].x});
    if (xx >= yy && xx >= zz) return normalized(Quat{c[1].z - c[2].y, 1 + xx - yy - zz, c[0].y + c[1].x, c[2].x + c[0].z});
    if (yy >= zz) return normalized(Quat{c[2].x - c[0].z, c[0].y + c[1].x, 1 + yy - xx - zz, c[1].z + c[2].y});
    return normalized(Quat{c[0].y - c[1].x, c[2].x + c[0].z, c[1].z + c[2].y, 1 + zz - xx - yy});
}

/// One rotation in the plane p, q that brings m(p, q) to 0.
void rotate_away(Mat3& m, Columns& v, int p, int q)
{
    if (m(p, q) == 0) return;
    const double theta = (m(q, q) - m(p, p)) / (2 * m(p, q));
    const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
    const double c = 1 / std::sqrt(t * t + 1), s = t * c;
    const int r = 3 - p - q;
    const double pq = m(p, q), pr = m(p, r), qr = m(q, r);
    m(p, p) -= t * pq, m(q, q) += t * pq, m(p, q) = m(q, p) = 0;
    m(p, r) = m(r, p) = c * pr - s * qr;
    m(q, r) = m(r, q) = s * pr + c * qr;
    const Vec3 a = v[static_cast<std::size_t>(p)], b = v[static_cast<std::size_t>(q)];
    v[static_cast<std::size_t>(p)] = a * c - b * s, v[static_cast<std::size_t>(q)] = a * s + b * c;
}

}  // namespace

PrincipalAxes principal_axes(const Mat3& inertia_B)
{
    Mat3 m = inertia_B;
    Columns v{axis(0), axis(1), axis(2)};
    for (int sweep = 0; sweep < 30 && std::fabs(m(0, 1)) + std::fabs(m(0, 2)) + std::fabs(m(1, 2)) > 0; ++sweep)
        for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) rotate_away(m, v, p, q);
    std::array<double, 3> d{m(0, 0), m(1, 1), m(2, 2)};
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)})
    {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        if (d[a] > d[b]) std::swap(d[a], d[b]), std::swap(v[a], v[b]);
    }
    if (dot(cross(v[0], v[1]), v[2]) < 0) v[2] = v[2] * -1.0;
    return {{d[0], d[1], d[2]}, quaternion_of(v)};
}

PrincipalAxes reversed(const PrincipalAxes& axes)
{
    const Columns v{rotate(axes.q_BP, axis(2)), rotate(axes.q_BP, axis(1)) * -1.0, rotate(axes.q_BP, axis(0))};
    return {{axes.moments.z, axes.moments.y, axes.moments.x}, quaternion_of(v)};
}

}  // namespace plab::world
