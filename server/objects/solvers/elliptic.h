/// Jacobi's elliptic functions sn, cn, dn of real argument, accurate for every modulus up to the separatrix.
#pragma once

#include <array>

namespace plab::solvers
{

struct JacobiValues
{
    double sn = 0, cn = 1, dn = 1;
    double cn_defect = 0, dn_defect = 0;  ///< 1 - cn, 1 - dn: small arguments need them to full relative precision
};

/// The functions for one parameter. It is given as its complement k'^2 = 1 - k^2, because near the separatrix that is
/// the number that matters. The descent by arithmetic-geometric means is done once; each value then costs one sine, one
/// cosine and two divisions per level (at most 9). Small arguments use Maclaurin's series and up to two doublings.
/// Sources: Bulirsch, "Numerical calculation of elliptic integrals and elliptic functions", Numer. Math. 7 (1965) 78-90;
/// Abramowitz, Stegun, 16.22 and 16.18.
class EllipticModulus
{
public:
    /// complement = k'^2, cut to [0, 1].
    explicit EllipticModulus(double complement);
    JacobiValues at(double u) const;
    /// K: sn has the period 4K, dn the period 2K. Infinite at the separatrix.
    double quarter_period() const { return quarter_period_; }

private:
    JacobiValues series(double u) const;

    static constexpr int kLevels = 14;
    double parameter_ = 0;                      ///< k^2
    std::array<double, 5> sn_{}, cn_{}, dn_{};  ///< Maclaurin's coefficients of u^2 .. u^10 in sn(u) / u, 1 - cn, 1 - dn
    std::array<double, kLevels> arithmetic_{}, geometric_{};
    int levels_ = 0;
    double mean_ = 1;
    double quarter_period_ = 0;
    bool separatrix_ = false;
};

}  // namespace plab::solvers
