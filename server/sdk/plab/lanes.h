/// Arithmetic on several numbers at once: Lanes<4> holds one number of each of four independent elements (contact pairs, bodies), Lanes<1>
/// is a double.
///
/// Each lane is computed by the same IEEE operations in the same order (no fused multiply-add, no sums across lanes), so the result does
/// not depend on the number of lanes nor on the instruction set that the compiler uses for them.
#pragma once

#include <cmath>
#include <cstring>

#include "plab/vector.h"

#define PLAB_INLINE inline __attribute__((always_inline))
// Everything here is inlined, so no function passes vectors across a binary interface.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace plab::lanes
{

template <int W>
struct LaneType;
template <>
struct LaneType<1>
{
    using type = double;
};
template <>
struct LaneType<4>
{
    // Said explicitly, as without AVX the compiler would align by 16 bytes only, but with it expect 32.
    typedef double type __attribute__((vector_size(4 * sizeof(double)), aligned(4 * sizeof(double))));
};
template <int W>
using Lanes = typename LaneType<W>::type;

PLAB_INLINE double& lane(double& x, int) { return x; }
PLAB_INLINE double lane(const double& x, int) { return x; }
PLAB_INLINE double lane(const Lanes<4>& x, int i) { return x[i]; }
PLAB_INLINE void set_lane(double& x, int, double value) { x = value; }
PLAB_INLINE void set_lane(Lanes<4>& x, int i, double value) { x[i] = value; }

PLAB_INLINE double larger(const double& a, const double& b) { return a > b ? a : b; }
PLAB_INLINE Lanes<4> larger(const Lanes<4>& a, const Lanes<4>& b) { return a > b ? a : b; }
PLAB_INLINE double smaller(const double& a, const double& b) { return a < b ? a : b; }
PLAB_INLINE Lanes<4> smaller(const Lanes<4>& a, const Lanes<4>& b) { return a < b ? a : b; }
PLAB_INLINE double size_of(const double& a) { return std::fabs(a); }
PLAB_INLINE Lanes<4> size_of(const Lanes<4>& a) { return a < 0 ? -a : a; }
PLAB_INLINE bool any(bool mask) { return mask; }
template <class Mask>
PLAB_INLINE bool any(const Mask& mask)
{
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}
PLAB_INLINE double root(const double& a) { return std::sqrt(a); }
PLAB_INLINE Lanes<4> root(const Lanes<4>& a) { return Lanes<4>{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; }

#if defined(__x86_64__)
template <class Work>
__attribute__((target("avx2"))) void run_with_avx2(const Work& work)
{
    work();
}

inline bool has_avx2()
{
    static const bool has = __builtin_cpu_supports("avx2") != 0;
    return has;
}
#endif

/// Calls work(), compiled for processors with AVX2 too if it computes on four lanes. `work` must be a lambda that is always inlined
/// (PLAB_LANES): it then is compiled for the instruction set of the function that it is inlined into.
template <int W, class Work>
void run_lanes(const Work& work)
{
#if defined(__x86_64__)
    if constexpr (W == 4)
        if (has_avx2()) return run_with_avx2(work);
#endif
    work();
}
#define PLAB_LANES [&]() __attribute__((always_inline))

/// A vector with a fourth, unused number, so that it is loaded and stored at once.
struct alignas(4 * sizeof(double)) PaddedVec3 : Vec3
{
    PaddedVec3() = default;
    PaddedVec3(const Vec3& v) : Vec3(v) {}
    double unused = 0;
};
PLAB_INLINE Lanes<4> load(const PaddedVec3& v)
{
    Lanes<4> out;
    std::memcpy(&out, &v, sizeof out);
    return out;
}
PLAB_INLINE void store(PaddedVec3& v, const Lanes<4>& numbers) { std::memcpy(static_cast<void*>(&v), &numbers, sizeof numbers); }
/// Four numbers that follow one another anywhere.
PLAB_INLINE Lanes<4> load(const double* numbers)
{
    Lanes<4> out;
    std::memcpy(&out, numbers, sizeof out);
    return out;
}
/// Exchanges rows and columns of the 4 x 4 numbers.
PLAB_INLINE void transpose(Lanes<4>& a, Lanes<4>& b, Lanes<4>& c, Lanes<4>& d)
{
    const Lanes<4> ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Lanes<4> cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5), c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
    b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5), d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

template <int W>
struct LaneVec
{
    Lanes<W> x{}, y{}, z{};
};
template <int W>
PLAB_INLINE Vec3 lane(const LaneVec<W>& v, int i)
{
    return {lane(v.x, i), lane(v.y, i), lane(v.z, i)};
}
template <int W>
PLAB_INLINE void set_lane(LaneVec<W>& v, int i, const Vec3& to)
{
    set_lane(v.x, i, to.x), set_lane(v.y, i, to.y), set_lane(v.z, i, to.z);
}
template <int W>
PLAB_INLINE LaneVec<W> operator+(const LaneVec<W>& a, const LaneVec<W>& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int W>
PLAB_INLINE LaneVec<W> operator-(const LaneVec<W>& a, const LaneVec<W>& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int W>
PLAB_INLINE LaneVec<W> scaled(const LaneVec<W>& a, const Lanes<W>& s)
{
    return {a.x * s, a.y * s, a.z * s};
}
template <int W>
PLAB_INLINE Lanes<W> dot(const LaneVec<W>& a, const LaneVec<W>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <int W>
PLAB_INLINE LaneVec<W> cross(const LaneVec<W>& a, const LaneVec<W>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// One vector of each lane.
PLAB_INLINE LaneVec<1> gathered(const PaddedVec3& a) { return {a.x, a.y, a.z}; }
PLAB_INLINE LaneVec<4> gathered(const PaddedVec3& a, const PaddedVec3& b, const PaddedVec3& c, const PaddedVec3& d)
{
    Lanes<4> rows[4] = {load(a), load(b), load(c), load(d)};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    LaneVec<4> out;
    out.x = rows[0], out.y = rows[1], out.z = rows[2];
    return out;
}

/// A symmetric 3 x 3 matrix.
template <int W>
struct LaneSymmetric
{
    Lanes<W> xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
};
/// The matrix of each lane; of each, the nine numbers are read row by row.
PLAB_INLINE LaneSymmetric<1> gathered(const Mat3& a) { return {a.m[0][0], a.m[0][1], a.m[0][2], a.m[1][1], a.m[1][2], a.m[2][2]}; }
PLAB_INLINE LaneSymmetric<4> gathered(const Mat3& a, const Mat3& b, const Mat3& c, const Mat3& d)
{
    Lanes<4> first[4] = {load(a.m[0]), load(b.m[0]), load(c.m[0]), load(d.m[0])};
    Lanes<4> second[4] = {load(a.m[0] + 4), load(b.m[0] + 4), load(c.m[0] + 4), load(d.m[0] + 4)};
    transpose(first[0], first[1], first[2], first[3]);
    transpose(second[0], second[1], second[2], second[3]);
    return {first[0], first[1], first[2], second[0], second[1], Lanes<4>{a.m[2][2], b.m[2][2], c.m[2][2], d.m[2][2]}};
}
template <int W>
PLAB_INLINE LaneVec<W> operator*(const LaneSymmetric<W>& m, const LaneVec<W>& v)
{
    return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z, m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

/// A 3 x 3 matrix.
struct LaneMat
{
    LaneVec<4> row[3];
};
PLAB_INLINE LaneVec<4> operator*(const LaneMat& a, const LaneVec<4>& v) { return {dot(a.row[0], v), dot(a.row[1], v), dot(a.row[2], v)}; }
PLAB_INLINE LaneVec<4> transposed_times(const LaneMat& a, const LaneVec<4>& v)
{
    return {a.row[0].x * v.x + a.row[1].x * v.y + a.row[2].x * v.z, a.row[0].y * v.x + a.row[1].y * v.y + a.row[2].y * v.z,
            a.row[0].z * v.x + a.row[1].z * v.y + a.row[2].z * v.z};
}

/// A quaternion, as Quat.
struct LaneQuat
{
    Lanes<4> w{}, x{}, y{}, z{};
};
PLAB_INLINE LaneQuat operator*(const LaneQuat& a, const LaneQuat& b)
{
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
PLAB_INLINE LaneQuat normalized(const LaneQuat& q)
{
    const Lanes<4> n = root(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w / n, q.x / n, q.y / n, q.z / n};
}
PLAB_INLINE LaneMat rotation_matrix(const LaneQuat& q)
{
    const Lanes<4> xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const Lanes<4> xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z, wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return {{{1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)},
             {2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)},
             {2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)}}};
}
PLAB_INLINE LaneVec<4> rotate(const LaneQuat& q, const LaneVec<4>& v)
{
    const LaneVec<4> u{q.x, q.y, q.z}, c = cross(u, v), t{2.0 * c.x, 2.0 * c.y, 2.0 * c.z};
    return v + scaled(t, q.w) + cross(u, t);
}
PLAB_INLINE LaneVec<4> rotate_back(const LaneQuat& q, const LaneVec<4>& v) { return rotate({q.w, -q.x, -q.y, -q.z}, v); }

}  // namespace plab::lanes
