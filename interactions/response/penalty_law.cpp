#include "penalty_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plab::response
{
namespace
{
constexpr double kLeastRestitution = 0.01;

/// ln(1/e) of a contact that ends with its force.
double decay_without_pull(double z)
{
    const double q = 1 - z * z;
    if (std::fabs(q) < 1e-8) return 2 * z;  // acos(z) / sqrt(1 - z^2) -> 1
    return q > 0 ? 2 * z * std::acos(z) / std::sqrt(q) : 2 * z * std::acosh(z) / std::sqrt(-q);
}

/// The zero in [low, high] of an increasing function f, by bisection.
template <class F>
double root(double low, double high, F f)
{
    for (int i = 0; i < 200; ++i)
    {
        const double middle = 0.5 * (low + high);
        if (!(middle > low && middle < high)) break;
        (f(middle) < 0 ? low : high) = middle;
    }
    return high;
}
}  // namespace

double ratio_for_restitution(double e)
{
    if (e >= 1) return 0;
    if (e <= 0) return 1;
    const double decay = -std::log(e);
    return decay / std::hypot(std::numbers::pi, decay);
}

double ratio_for_restitution_without_pull(double e)
{
    if (e >= 1) return 0;
    const double decay = -std::log(std::max(e, kLeastRestitution));
    return root(0.0, 10.0, [&](double z) { return decay_without_pull(z) - decay; });
}

double loss_for_restitution(double e)
{
    if (e >= 1) return 0;
    const double r = std::max(e, kLeastRestitution);
    // The function also has a zero at s = 0, below which it falls by about (1 - e^2) s^2 / 2; this bound excludes that one.
    const double low = 0.75 * (1 - r);
    return root(low, 1 / r, [&](double s) { return std::log1p(s) - std::log1p(-r * s) - (1 + r) * s; });
}

double stiffness_at_approach(double k, double n, double speed, double inverse_mass)
{
    return n * k * std::pow(0.5 * (n + 1) * speed * speed / (k * inverse_mass), (n - 1) / (n + 1));
}

namespace
{
Vec3 limited(const Vec3& force, double limit)
{
    const double size = length(force);
    return size > limit ? force * (limit / size) : force;
}
}  // namespace

SurfaceForce surface_force(double k, double c, double limit, const Vec3& stretch, const Vec3& slip)
{
    SurfaceForce out;
    if (!(limit > 0) || !(k > 0)) return out;
    const Vec3 spring = limited(stretch * -k, limit);
    out.stretch = k * length(stretch) > limit ? spring * (-1 / k) : stretch;
    out.force = limited(spring - slip * c, limit);
    out.stored = 0.5 * k * length_squared(out.stretch);
    return out;
}

}  // namespace plab::response
