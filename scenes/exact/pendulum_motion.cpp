#include "exact/pendulum_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "exact/elliptic.h"

namespace plab::exact
{

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
