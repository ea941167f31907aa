#include "world/principal_axes.h"

#include <array>
#include <cmath>
#include <utility>

#include "plab/symmetric.h"

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

}  // namespace

PrincipalAxes principal_axes(const Mat3& inertia_B)
{
    const SymmetricAxes found = symmetric_axes(inertia_B);
    const Mat3& R = found.axes;
    Columns v{Vec3{R(0, 0), R(1, 0), R(2, 0)}, Vec3{R(0, 1), R(1, 1), R(2, 1)}, Vec3{R(0, 2), R(1, 2), R(2, 2)}};
    std::array<double, 3> d{found.values.x, found.values.y, found.values.z};
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
