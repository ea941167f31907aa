/// Jacobi's elliptic functions sn, cn, dn of real argument, accurate for every modulus up to the separatrix.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace plab
{

struct JacobiValues
{
    double sn = 0, cn = 1, dn = 1;
    double cn_defect = 0, dn_defect = 0;  ///< 1 - cn and 1 - dn, needed to full relative precision for small arguments
};

/// The functions for one parameter, which is given as its complement k'^2 = 1 - k^2, because that is the number that matters near the
/// separatrix. The descent by arithmetic-geometric means is done once; each value then costs one sine, one cosine and two divisions per
/// level (at most 9). Small arguments use the Maclaurin series and up to two doublings. Sources: Bulirsch, "Numerical calculation of
/// elliptic integrals and elliptic functions", Numer. Math. 7 (1965) 78-90; Abramowitz, Stegun, 16.22 and 16.18.
class EllipticModulus
{
public:
    /// complement = k'^2, clamped to [0, 1].
    explicit EllipticModulus(double complement);
    JacobiValues at(double u) const;
    /// K: sn has the period 4K and dn the period 2K. Infinite at the separatrix.
    double quarter_period() const { return quarter_period_; }

private:
    JacobiValues series(double u) const;

    static constexpr int kLevels = 14;
    double parameter_ = 0;                      ///< k^2
    std::array<double, 5> sn_{}, cn_{}, dn_{};  ///< Maclaurin coefficients of u^2 .. u^10 in sn(u) / u, 1 - cn, 1 - dn
    std::array<double, kLevels> arithmetic_{}, geometric_{};
    int levels_ = 0;
    double mean_ = 1;
    double quarter_period_ = 0;
    bool separatrix_ = false;
};

inline EllipticModulus::EllipticModulus(double complement)
{
    double g = std::clamp(complement, 0.0, 1.0);
    const double m = 1 - g;
    parameter_ = m;
    sn_ = {-(1 + m) / 6, (1 + m * (14 + m)) / 120, -(1 + m * (135 + m * (135 + m))) / 5040,
           (1 + m * (1228 + m * (5478 + m * (1228 + m)))) / 362880,
           -(1 + m * (11069 + m * (165826 + m * (165826 + m * (11069 + m))))) / 39916800};
    cn_ = {0.5, -(1 + 4 * m) / 24, (1 + m * (44 + 16 * m)) / 720, -(1 + m * (408 + m * (912 + 64 * m))) / 40320,
           (1 + m * (3688 + m * (30768 + m * (15808 + 256 * m)))) / 3628800};
    dn_ = {m / 2, -m * (4 + m) / 24, m * (16 + m * (44 + m)) / 720, -m * (64 + m * (912 + m * (408 + m))) / 40320,
           m * (256 + m * (15808 + m * (30768 + m * (3688 + m)))) / 3628800};
    separatrix_ = g == 0;
    if (separatrix_)
    {
        quarter_period_ = std::numeric_limits<double>::infinity();
        return;
    }
    double a = 1;
    for (levels_ = 0; levels_ < kLevels;)
    {
        g = std::sqrt(g);
        arithmetic_[static_cast<std::size_t>(levels_)] = a, geometric_[static_cast<std::size_t>(levels_)] = g;
        ++levels_;
        mean_ = 0.5 * (a + g);
        if (std::fabs(a - g) <= 1e-8 * a) break;  // the next mean is exact to rounding, because the descent converges quadratically
        g *= a, a = mean_;
    }
    quarter_period_ = 0.5 * std::numbers::pi / mean_;
}

inline JacobiValues EllipticModulus::series(double u) const
{
    const double x = u * u;
    const auto sum = [x](const std::array<double, 5>& c) { return x * (c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * c[4])))); };
    const double c = sum(cn_), d = sum(dn_);
    return {u + u * sum(sn_), 1 - c, 1 - d, c, d};
}

inline JacobiValues EllipticModulus::at(double u) const
{
    if (std::fabs(u) <= 0.2)
    {
        // The series end with u^10, which is exact to rounding for |u| <= 0.05 because all poles are at least pi/2 away.
        const int doublings = std::fabs(u) <= 0.05 ? 0 : (std::fabs(u) <= 0.1 ? 1 : 2);
        JacobiValues v = series(doublings == 0 ? u : (doublings == 1 ? 0.5 * u : 0.25 * u));
        for (int i = 0; i < doublings; ++i)
        {
            const double c = v.cn, e = v.dn, ss = v.sn * v.sn, d = 2 / (1 - parameter_ * ss * ss);
            const double no_c = ss * e * e * d, no_d = parameter_ * ss * c * c * d;
            v = {v.sn * c * e * d, 1 - no_c, 1 - no_d, no_c, no_d};
        }
        return v;
    }
    if (separatrix_)
    {
        const double e = std::exp(-std::fabs(u));
        const double sech = 2 * e / (1 + e * e);
        return {std::tanh(u), sech, sech, 1 - sech, 1 - sech};
    }
    const double phase = u * mean_;
    const double sine = std::sin(phase);
    if (sine == 0) return {0, std::cos(phase), 1, 1 - std::cos(phase), 0};
    double a = std::cos(phase) / sine, c = mean_ * a, dn = 1;
    for (int i = levels_ - 1; i >= 0; --i)
    {
        const double b = arithmetic_[static_cast<std::size_t>(i)];
        a *= c, c *= dn;
        dn = (geometric_[static_cast<std::size_t>(i)] + a) / (b + a);
        a = c / b;
    }
    const double size = 1 / std::sqrt(c * c + 1);
    const double sn = sine >= 0 ? size : -size;
    return {sn, c * sn, dn, 1 - c * sn, 1 - dn};
}

}  // namespace plab
