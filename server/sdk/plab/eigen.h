/// Eigen views of vectors, matrices, columns and host tables. A view is an Eigen::Map on the same numbers; nothing is copied.
///
/// This header is opt-in: no other header of the SDK includes it, because Eigen takes two seconds to compile. Vec3, Mat3 and Quat
/// themselves stay plain, because the layout of a plugin's interface must not depend on the compiler flags that Eigen's alignment
/// depends on. Views assume no alignment. A plugin that includes this header says `plab_plugin(NAME ${sources} LINK plab_eigen)`.
///
///   as_eigen(bodies.velocity[i]) += h * as_eigen(bodies.inverse_inertia_B[i]) * torque;   // one vector, one matrix
///   as_eigen(bodies.velocity).colwise() += h * g;                                       // 3 x n, a column for each body
///   as_eigen(rows.speed) *= 0.5;                                                        // a Column<double>, n x 1
///
/// A view is valid as long as its table keeps its size.
///
/// The header also sets how Eigen computes, so it must come before Eigen's own headers (server/docs/determinism.md explains why):
/// - EIGEN_DONT_PARALLELIZE: no threads.
/// - Blocks of fixed size in products of large matrices: Eigen's own sizes, and with them the order of long sums, depend on the
///   caches of the processor. Blocks of this size fit on the stack.
/// - Two doubles at a time by SSE2, which every x86-64 processor has, otherwise one: with wider registers the order of sums would
///   depend on addresses, and Eigen would contract a * b + c.
/// With these flags gcc and clang, -O0 and -O2 give the same bits. This does not hold for Eigen's exp, log, sin and cos of arrays; use
/// those of the standard library.
#pragma once

#ifdef EIGEN_CORE_H
#error "plab/eigen.h sets how Eigen computes: include it before Eigen's own headers"
#endif
#define EIGEN_MPL2_ONLY
#define EIGEN_DONT_PARALLELIZE
#define EIGEN_STRONG_INLINE __attribute__((always_inline)) inline
#define EIGEN_TEST_SPECIFIC_BLOCKING_SIZES 1
#define EIGEN_TEST_SPECIFIC_BLOCKING_SIZE_K 128
#define EIGEN_TEST_SPECIFIC_BLOCKING_SIZE_M 64
#define EIGEN_TEST_SPECIFIC_BLOCKING_SIZE_N 128
#if !defined(__SSE2__) || defined(__AVX__)
#define EIGEN_DONT_VECTORIZE
#endif

#include <Eigen/Core>
#include <span>
#include <type_traits>
#include <vector>

#include "plab/column.h"
#include "plab/vector.h"

namespace plab
{

// The views depend on this layout: so many doubles, one after the other.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && std::is_standard_layout_v<Vec3>);
static_assert(sizeof(Quat) == 4 * sizeof(double) && std::is_standard_layout_v<Quat>);
static_assert(sizeof(Mat3) == 9 * sizeof(double) && std::is_standard_layout_v<Mat3>);

/// Row-major, as Mat3 is stored.
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// One value.
inline Eigen::Map<Eigen::Vector3d> as_eigen(Vec3& v) { return Eigen::Map<Eigen::Vector3d>(&v.x); }
inline Eigen::Map<const Eigen::Vector3d> as_eigen(const Vec3& v) { return Eigen::Map<const Eigen::Vector3d>(&v.x); }
inline Eigen::Map<RowMatrix3d> as_eigen(Mat3& a) { return Eigen::Map<RowMatrix3d>(&a.m[0][0]); }
inline Eigen::Map<const RowMatrix3d> as_eigen(const Mat3& a) { return Eigen::Map<const RowMatrix3d>(&a.m[0][0]); }
/// The four numbers w, x, y, z.
inline Eigen::Map<Eigen::Vector4d> as_eigen(Quat& q) { return Eigen::Map<Eigen::Vector4d>(&q.w); }
inline Eigen::Map<const Eigen::Vector4d> as_eigen(const Quat& q) { return Eigen::Map<const Eigen::Vector4d>(&q.w); }

// Results by value: a Vec3 of three numbers, a Mat3 of 3 x 3. A quaternion becomes Eigen's by its numbers, Eigen::Quaterniond{q.w, q.x,
// q.y, q.z}: there is no view, because Eigen stores w last. <Eigen/Geometry> is not included here, as it doubles the time to compile.
template <class Derived>
auto from_eigen(const Eigen::MatrixBase<Derived>& a)
{
    static_assert(Derived::RowsAtCompileTime == 3 && (Derived::ColsAtCompileTime == 1 || Derived::ColsAtCompileTime == 3));
    std::conditional_t<Derived::ColsAtCompileTime == 1, Vec3, Mat3> out;
    as_eigen(out) = a;
    return out;
}
template <class Derived>
Quat from_eigen(const Eigen::QuaternionBase<Derived>& q)
{
    return {q.w(), q.x(), q.y(), q.z()};
}

/// The view of a list of T: numbers are an n x 1 vector; Vec3, Quat and Mat3 (row-major) are a matrix of 3, 4 or 9 rows with a column
/// for each element.
template <class T>
inline constexpr int kEigenRows = std::is_same_v<T, Vec3>   ? 3
                                  : std::is_same_v<T, Quat> ? 4
                                  : std::is_same_v<T, Mat3> ? 9
                                                            : 0;
template <class T>
concept EigenElement = std::is_same_v<T, double> || kEigenRows<T>
!= 0;

namespace detail
{

template <class T>
using EigenList = std::conditional_t<std::is_same_v<T, double>, Eigen::VectorXd,
                                     Eigen::Matrix<double, kEigenRows<T> == 0 ? Eigen::Dynamic : kEigenRows<T>, Eigen::Dynamic>>;

/// T may be const.
template <class T>
auto view_of(T* first, std::size_t count)
{
    using Plain = std::remove_const_t<T>;
    using List = std::conditional_t<std::is_const_v<T>, const EigenList<Plain>, EigenList<Plain>>;
    const auto n = static_cast<Eigen::Index>(count);
    if constexpr (std::is_same_v<Plain, double>)
        return Eigen::Map<List>(first, n);
    else
        return Eigen::Map<List>(count == 0 ? nullptr : as_eigen(*first).data(), kEigenRows<Plain>, n);
}

}  // namespace detail

/// A span of a host table or of any other array.
template <class T>
requires EigenElement<std::remove_const_t<T>>
auto as_eigen(std::span<T> list) { return detail::view_of(list.data(), list.size()); }
/// A field of a host table, such as Bodies::position.
template <EigenElement T>
auto as_eigen(std::vector<T>& list)
{
    return detail::view_of(list.data(), list.size());
}
template <EigenElement T>
auto as_eigen(const std::vector<T>& list)
{
    return detail::view_of(list.data(), list.size());
}
/// A plugin's own column.
template <EigenElement T>
auto as_eigen(Column<T>& column)
{
    return detail::view_of(column.size() == 0 ? nullptr : &column[0], column.size());
}
template <EigenElement T>
auto as_eigen(const Column<T>& column)
{
    return detail::view_of(column.size() == 0 ? nullptr : &column[0], column.size());
}
// A view of a temporary value would outlive it.
template <EigenElement T>
void as_eigen(const std::vector<T>&&) = delete;
void as_eigen(const Vec3&&) = delete;
void as_eigen(const Mat3&&) = delete;
void as_eigen(const Quat&&) = delete;

}  // namespace plab
