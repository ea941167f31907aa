/// Vectors, rotations and poses: the geometry that the host and all plugins share.
///
/// Plain values in double precision. Every sum is written out in one fixed order, so all builds round alike (server/docs/determinism.md).
/// Notation as in server/docs/notation.md: p_WB is the position of B measured in W.
#pragma once

#include <cmath>

namespace plab
{

/// A vector of three components; unit and frame are stated where it is used.
struct Vec3
{
    double x = 0, y = 0, z = 0;

    constexpr double operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
    constexpr double& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
    constexpr Vec3& operator+=(const Vec3& b)
    {
        x += b.x, y += b.y, z += b.z;
        return *this;
    }
    constexpr Vec3& operator-=(const Vec3& b)
    {
        x -= b.x, y -= b.y, z -= b.z;
        return *this;
    }
    constexpr Vec3& operator*=(double s)
    {
        x *= s, y *= s, z *= s;
        return *this;
    }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, double s) { return a *= s; }
constexpr Vec3 operator*(double s, Vec3 a) { return a *= s; }
constexpr Vec3 operator/(const Vec3& a, double s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(const Vec3& a, const Vec3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
constexpr double length_squared(const Vec3& a) { return dot(a, a); }
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// The direction of a; the zero vector remains zero.
inline Vec3 normalized(const Vec3& a)
{
    const double n = length(a);
    return n > 0 ? a / n : Vec3{};
}
inline bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// A unit vector perpendicular to the unit vector n.
inline Vec3 any_perpendicular(const Vec3& n)
{
    const Vec3 axis = std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return normalized(cross(n, axis));
}

/// A 3x3 matrix, row by row.
struct Mat3
{
    double m[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

    constexpr double operator()(int r, int c) const { return m[r][c]; }
    constexpr double& operator()(int r, int c) { return m[r][c]; }
    friend constexpr bool operator==(const Mat3&, const Mat3&) = default;

    static constexpr Mat3 diagonal(double a, double b, double c) { return {{{a, 0, 0}, {0, b, 0}, {0, 0, c}}}; }
    static constexpr Mat3 identity() { return diagonal(1, 1, 1); }
};

constexpr Vec3 operator*(const Mat3& a, const Vec3& v)
{
    return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
            a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}
/// The product of the transpose of a with v.
constexpr Vec3 transposed_times(const Mat3& a, const Vec3& v)
{
    return {a.m[0][0] * v.x + a.m[1][0] * v.y + a.m[2][0] * v.z, a.m[0][1] * v.x + a.m[1][1] * v.y + a.m[2][1] * v.z,
            a.m[0][2] * v.x + a.m[1][2] * v.y + a.m[2][2] * v.z};
}
constexpr Mat3 operator*(const Mat3& a, const Mat3& b)
{
    Mat3 r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    return r;
}
constexpr Mat3 operator+(const Mat3& a, const Mat3& b)
{
    Mat3 r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[i][j] + b.m[i][j];
    return r;
}
constexpr Mat3 operator*(const Mat3& a, double s)
{
    Mat3 r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[i][j] * s;
    return r;
}
constexpr Mat3 operator-(const Mat3& a, const Mat3& b) { return a + b * -1.0; }
constexpr Mat3 transposed(const Mat3& a)
{
    Mat3 r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[j][i];
    return r;
}
/// a b^T.
constexpr Mat3 outer(const Vec3& a, const Vec3& b)
{
    return {{{a.x * b.x, a.x * b.y, a.x * b.z}, {a.y * b.x, a.y * b.y, a.y * b.z}, {a.z * b.x, a.z * b.y, a.z * b.z}}};
}
constexpr double determinant(const Mat3& a)
{
    return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) - a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
           a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}
/// The inverse by cofactors. The caller ensures that a is not singular.
constexpr Mat3 inverse(const Mat3& a)
{
    const double d = 1.0 / determinant(a);
    Mat3 r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
            const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            r.m[j][i] = (a.m[i1][j1] * a.m[i2][j2] - a.m[i1][j2] * a.m[i2][j1]) * d;
        }
    return r;
}

/// A unit quaternion, scalar first: q_WB turns vectors of frame B into frame W.
struct Quat
{
    double w = 1, x = 0, y = 0, z = 0;
    friend constexpr bool operator==(const Quat&, const Quat&) = default;
};

constexpr Quat operator*(const Quat& a, const Quat& b)
{
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
constexpr Quat conjugate(const Quat& q) { return {q.w, -q.x, -q.y, -q.z}; }
inline double norm(const Quat& q) { return std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z); }
inline Quat normalized(const Quat& q)
{
    const double n = norm(q);
    return {q.w / n, q.x / n, q.y / n, q.z / n};
}
inline bool is_finite(const Quat& q) { return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z); }
/// The rotation matrix of a unit quaternion.
constexpr Mat3 rotation_matrix(const Quat& q)
{
    const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z, wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return {{{1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)},
             {2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)},
             {2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)}}};
}
constexpr Vec3 rotate(const Quat& q, const Vec3& v)
{
    const Vec3 u{q.x, q.y, q.z};
    const Vec3 t = 2.0 * cross(u, v);
    return v + q.w * t + cross(u, t);
}
constexpr Vec3 rotate_back(const Quat& q, const Vec3& v) { return rotate(conjugate(q), v); }

/// Position and orientation of a frame B in a frame W.
struct Pose
{
    Vec3 p;  ///< p_WB, m
    Quat q;  ///< q_WB
    friend constexpr bool operator==(const Pose&, const Pose&) = default;
};

constexpr Vec3 operator*(const Pose& X, const Vec3& p) { return X.p + rotate(X.q, p); }
constexpr Pose operator*(const Pose& a, const Pose& b) { return {a * b.p, a.q * b.q}; }
constexpr Pose inverse(const Pose& X) { return {-rotate_back(X.q, X.p), conjugate(X.q)}; }

}  // namespace plab
