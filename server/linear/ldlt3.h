/// A symmetric positive definite matrix of up to 3 x 3, factored as L D L^T without pivoting: the inertia that a joint of a tree sees.
///
/// Eigen's LDLT of a 3 x 3 matrix searches pivots, and takes several times as long for the same digits; a tree of ball joints would pay
/// that for each link and stage (tests/unit/simulation_rows/small_blocks_test.cpp).
#pragma once

#include <array>
#include <cstddef>

namespace plab::linear
{

class Ldlt3
{
public:
    /// The lower triangle of the matrix, row by row: a00 a10 a11 a20 a21 a22. Only the first n rows are read; n is 1 to 3.
    void factor(const std::array<double, 6>& a, std::size_t n)
    {
        inverse_d_[0] = 1 / a[0];
        if (n == 1) return;
        l10_ = a[1] * inverse_d_[0];
        inverse_d_[1] = 1 / (a[2] - l10_ * a[1]);
        if (n == 2) return;
        l20_ = a[3] * inverse_d_[0];
        const double b21 = a[4] - l20_ * a[1];
        l21_ = b21 * inverse_d_[1];
        inverse_d_[2] = 1 / (a[5] - l20_ * a[3] - l21_ * b21);
    }

    /// b := A^-1 b, for the first n elements of b.
    void solve(std::array<double, 3>& b, std::size_t n) const
    {
        if (n > 1) b[1] -= l10_ * b[0];
        if (n > 2) b[2] -= l20_ * b[0] + l21_ * b[1];
        for (std::size_t k = 0; k < n; ++k) b[k] *= inverse_d_[k];
        if (n > 2) b[1] -= l21_ * b[2];
        if (n > 1) b[0] -= l10_ * b[1] + (n > 2 ? l20_ * b[2] : 0);
    }

private:
    std::array<double, 3> inverse_d_{};
    double l10_ = 0, l20_ = 0, l21_ = 0;
};

}  // namespace plab::linear
