/// Eigenvalues and axes of a symmetric 3 x 3 matrix, such as an inertia.
#pragma once

#include <cmath>
#include <utility>

#include "plab/vector.h"

namespace plab
{

/// Whether a is a number times the identity, as the inertia of a ball or a cube is: such a body has the same inertia in all axes.
constexpr bool is_isotropic(const Mat3& a)
{
    return a(0, 0) == a(1, 1) && a(1, 1) == a(2, 2) && a(0, 1) == 0 && a(0, 2) == 0 && a(1, 2) == 0 && a(1, 0) == 0 && a(2, 0) == 0 &&
           a(2, 1) == 0;
}

struct SymmetricAxes
{
    Vec3 values;  ///< in no particular order; of a diagonal matrix its own
    Mat3 axes;    ///< columns, a proper rotation R: the matrix is R diag(values) R^T
};

/// Makes a(p, q) zero by a rotation in their plane (Golub, Van Loan, Matrix computations, algorithm 8.5.1).
inline void rotate_away(Mat3& a, Mat3& axes, int p, int q)
{
    if (a(p, q) == 0) return;
    const double tau = (a(q, q) - a(p, p)) / (2 * a(p, q));
    const double t = (tau >= 0 ? 1.0 : -1.0) / (std::fabs(tau) + std::sqrt(1 + tau * tau));
    const double c = 1 / std::sqrt(1 + t * t), s = t * c;
    const int r = 3 - p - q;
    const double apq = a(p, q), arp = a(r, p), arq = a(r, q);
    a(p, p) -= t * apq;
    a(q, q) += t * apq;
    a(p, q) = a(q, p) = 0;
    a(r, p) = a(p, r) = c * arp - s * arq;
    a(r, q) = a(q, r) = s * arp + c * arq;
    for (int i = 0; i < 3; ++i)
    {
        const double x = axes(i, p), y = axes(i, q);
        axes(i, p) = c * x - s * y, axes(i, q) = s * x + c * y;
    }
}

/// By cyclic Jacobi rotations: small eigenvalues of a graded matrix keep their relative accuracy (Demmel, Veselic, SIAM J. Matrix Anal.
/// 13 (1992) 1204), which the thin axis of a rod needs. Eigen's SelfAdjointEigenSolver is accurate only relative to the largest
/// eigenvalue (tests/unit/sdk/eigen_test.cpp). Convergence is quadratic, in about five sweeps. A diagonal matrix keeps its bits.
inline SymmetricAxes symmetric_axes(const Mat3& symmetric)
{
    Mat3 a = symmetric;
    SymmetricAxes out{{}, Mat3::identity()};
    for (int sweep = 0; sweep < 30 && std::fabs(a(0, 1)) + std::fabs(a(0, 2)) + std::fabs(a(1, 2)) > 0; ++sweep)
        for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) rotate_away(a, out.axes, p, q);
    out.values = {a(0, 0), a(1, 1), a(2, 2)};
    return out;
}

}  // namespace plab
