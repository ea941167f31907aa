/// Solves x'' = -w2 x - 2 g x' from (x0, v0): under-damped, critical and over-damped in one formula.
#pragma once

#include <cmath>

namespace plab::exact
{

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

}  // namespace plab::exact
