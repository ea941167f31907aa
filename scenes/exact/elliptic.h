/// Elliptic integrals and Jacobi's elliptic functions, to a few ulp, for closed forms of tops and pendulums.
/// Sources: B. C. Carlson, Numerical computation of real or complex elliptic integrals, Numer. Algorithms 10 (1995); Abramowitz
/// and Stegun 16.4 (arithmetic-geometric mean). The functions take the complementary parameter mc = 1 - m, because next to the
/// separatrix m has no digits left.
#pragma once

namespace plab::exact
{

struct Jacobi
{
    double sn = 0, cn = 1, dn = 1;
};

/// sn, cn and dn of u; 0 <= mc <= 1.
Jacobi jacobi(double u, double mc);
/// K(m), the quarter period; mc > 0.
double quarter_period(double mc);
/// F(phi | m) for any phi.
double elliptic_f(double phi, double mc);
/// The amplitude am(u | m), increasing with u without jumps.
double amplitude(double u, double mc);
/// Carlson's R_F.
double carlson_rf(double x, double y, double z);

}  // namespace plab::exact
