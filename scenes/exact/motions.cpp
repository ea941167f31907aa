#include "exact/motions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plab::exact
{

double carlson_rf(double x, double y, double z)
{
    // Duplication until the arguments agree to 1e-3: the series below then errs by less than 1e-18.
    for (int i = 0; i < 60; ++i)
    {
        const double mean = (x + y + z) / 3;
        const double spread = std::max({std::fabs(mean - x), std::fabs(mean - y), std::fabs(mean - z)});
        if (spread <= 1e-3 * mean) break;
        const double sx = std::sqrt(x), sy = std::sqrt(y), sz = std::sqrt(z);
        const double shift = sx * sy + sy * sz + sz * sx;
        x = 0.25 * (x + shift), y = 0.25 * (y + shift), z = 0.25 * (z + shift);
    }
    const double mean = (x + y + z) / 3;
    const double dx = 1 - x / mean, dy = 1 - y / mean, dz = -dx - dy;
    const double e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
    return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44 - 5 * e2 * e2 * e2 / 208 + 3 * e3 * e3 / 104) / std::sqrt(mean);
}

double quarter_period(double mc) { return carlson_rf(0, mc, 1); }

double elliptic_f(double phi, double mc)
{
    const double turns = std::round(phi / std::numbers::pi);
    const double rest = phi - turns * std::numbers::pi;
    const double s = std::sin(rest), c = std::cos(rest);
    const double base = s * carlson_rf(c * c, c * c + mc * s * s, 1);
    return turns == 0 ? base : base + 2 * turns * quarter_period(mc);
}

Jacobi jacobi(double u, double mc)
{
    constexpr int kMost = 16;
    if (mc <= 0) return {std::tanh(u), 1 / std::cosh(u), 1 / std::cosh(u)};
    double a[kMost + 1], c[kMost + 1];
    double b = std::sqrt(mc);
    a[0] = 1, c[0] = std::sqrt(1 - mc);
    int n = 0;
    while (n < kMost && std::fabs(c[n]) > 1e-17 * a[n])
    {
        a[n + 1] = 0.5 * (a[n] + b);
        c[n + 1] = 0.5 * (a[n] - b);
        b = std::sqrt(a[n] * b);
        ++n;
    }
    double phi = std::ldexp(a[n] * u, n);
    for (int i = n; i > 0; --i) phi = 0.5 * (phi + std::asin(std::clamp(c[i] * std::sin(phi) / a[i], -1.0, 1.0)));
    Jacobi out{std::sin(phi), std::cos(phi), 0};
    // dn^2 = cn^2 + mc sn^2 has no cancellation, whatever mc.
    out.dn = std::sqrt(out.cn * out.cn + mc * out.sn * out.sn);
    return out;
}

double amplitude(double u, double mc)
{
    const double period = 4 * quarter_period(mc);
    const double turns = std::floor(u / period + 0.5);
    const Jacobi j = jacobi(u - turns * period, mc);
    return std::atan2(j.sn, j.cn) + 2 * std::numbers::pi * turns;
}

PendulumMotion::PendulumMotion(double w0, double theta, double speed) : w0_(w0)
{
    // The force does not depend on whole turns.
    turns_ = 2 * std::numbers::pi * std::round(theta / (2 * std::numbers::pi));
    const double half = 0.5 * (theta - turns_), s = std::sin(half), c = std::cos(half), u = 0.5 * speed / w0;
    k2_ = s * s + u * u;
    excess_ = c * c - u * u;  // 1 - k^2
    swings_ = excess_ > 0;
    if (swings_)
        mc_ = excess_, tau0_ = k2_ > 0 ? elliptic_f(std::atan2(s, u), mc_) : 0;
    else
        mc_ = -excess_ / k2_, sign_ = speed < 0 ? -1 : 1, tau0_ = elliptic_f(sign_ * half, mc_);
}

void PendulumMotion::at(double t, double& theta, double& speed) const
{
    const double k = std::sqrt(k2_), u = tau0_ + w0_ * t * (swings_ ? 1 : k);
    const Jacobi j = jacobi(u, mc_);
    if (swings_)
        theta = turns_ + 2 * std::asin(k * j.sn), speed = 2 * k * w0_ * j.cn;
    else
        theta = turns_ + sign_ * 2 * amplitude(u, mc_), speed = sign_ * 2 * k * w0_ * j.dn;
}

double PendulumMotion::time_of_turn() const
{
    if (!swings_ || !(k2_ > 0)) return std::numeric_limits<double>::infinity();
    // cn = 0 at odd multiples of K.
    const double quarter = quarter_period(mc_);
    double n = 2 * std::floor((tau0_ / quarter + 1) / 2) + 1;
    if (n * quarter <= tau0_ * (1 + 1e-15)) n += 2;
    if ((n - 2) * quarter > tau0_ * (1 + 1e-15)) n -= 2;
    return (n * quarter - tau0_) / w0_;
}

double PendulumMotion::fastest() const { return 2 * w0_ * std::sqrt(std::max(1.0, k2_)); }

}  // namespace plab::exact
