/// Motions with a closed form that several references share: the damped oscillator, the pendulum, the rocking block; and the elliptic
/// functions of which some are made.
#pragma once

#include <cmath>

namespace plab::exact
{

/// Solves x'' = -w2 x - 2 g x' from (x0, v0): under-damped, critical and over-damped in one formula.
struct Damped
{
    double w2 = 0;  ///< 1/s^2
    double g = 0;   ///< 1/s

    void at(double t, double x0, double v0, double& x, double& v) const
    {
        const double d = w2 - g * g, fade = std::exp(-g * t);
        if (d < 0) return over(t, std::sqrt(-d), x0, v0, x, v);
        // cos(w t) and sin(w t)/w
        const double c = d > 0 ? std::cos(std::sqrt(d) * t) : 1, s = d > 0 ? std::sin(std::sqrt(d) * t) / std::sqrt(d) : t;
        x = fade * (x0 * c + (v0 + g * x0) * s);
        v = fade * (v0 * c - (w2 * x0 + g * v0) * s);
    }

private:
    /// Decays slow = w2/fast, without the cancellation of g - sqrt(g^2 - w2).
    void over(double t, double r, double x0, double v0, double& x, double& v) const
    {
        const double fast = g + r, slow = w2 / fast;
        const double a = (v0 + fast * x0) / (fast - slow), b = -(v0 + slow * x0) / (fast - slow);
        const double ea = a * std::exp(-slow * t), eb = b * std::exp(-fast * t);
        x = ea + eb, v = -slow * ea - fast * eb;
    }
};

/// A block that rocks from one edge to the other: what it keeps of its turning speed at each impact, w'/w, as the angular momentum about
/// the edge that strikes is conserved and nothing rebounds. `gyration2`: J/m about the centre, m^2; half sizes in m. Source: G. W. Housner,
/// The behavior of inverted pendulum structures during earthquakes, Bull. Seism. Soc. Am. 53 (1963) 403.
inline double kept_by_rocking(double gyration2, double half_width, double half_height)
{
    const double b2 = half_width * half_width, h2 = half_height * half_height;
    return (gyration2 + h2 - b2) / (gyration2 + h2 + b2);
}

/// Elliptic integrals and Jacobi's elliptic functions, to a few ulp, for closed forms of tops and pendulums.
/// Sources: B. C. Carlson, Numerical computation of real or complex elliptic integrals, Numer. Algorithms 10 (1995); Abramowitz
/// and Stegun 16.4 (arithmetic-geometric mean). The functions take the complementary parameter mc = 1 - m, because next to the
/// separatrix m has no digits left.
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

/// theta'' = -w0^2 sin theta from any angle and speed, by Jacobi's elliptic functions: libration and rotation.
///
/// sin(theta/2) = k sn(tau0 + w0 t | k^2), or theta = 2 am(tau0 + k w0 t | 1/k^2) beyond the separatrix, with
/// k^2 = sin^2(theta/2) + (theta'/2 w0)^2 (Abramowitz and Stegun, 16 and 17).
class PendulumMotion
{
public:
    /// theta in rad from the stable equilibrium, speed in rad/s; w0 > 0.
    PendulumMotion(double w0, double theta, double speed);

    void at(double t, double& theta, double& speed) const;
    /// The first t > 0 at which the speed is 0; infinite if the pendulum rotates.
    double time_of_turn() const;
    double frequency() const { return w0_; }
    double k2() const { return k2_; }
    /// Largest angular rate that phases have, rad/s.
    double fastest() const;

private:
    double w0_, turns_ = 0, k2_ = 0, excess_ = 1, mc_ = 1, tau0_ = 0, sign_ = 1;
    bool swings_ = true;
};

}  // namespace plab::exact
