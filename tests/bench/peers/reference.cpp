#include "bench/peers/reference.h"

#include <cmath>

namespace plab::peers
{

FreeRotation::FreeRotation(const Vec3& inertia, const Vec3& spin, double duration, int steps_per_second)
    : inertia_{inertia.x, inertia.y, inertia.z}
{
    const int stride = steps_per_second / kKept;
    const long double h = 1.0L / (static_cast<long double>(stride) * kKept);
    State y{spin.x, spin.y, spin.z, 1, 0, 0, 0};
    kept_.push_back(y);
    const int kept = static_cast<int>(std::ceil(duration * kKept));
    for (int i = 0; i < kept; ++i)
    {
        for (int j = 0; j < stride; ++j) y = advanced(y, h);
        kept_.push_back(y);
    }
}

FreeRotation::State FreeRotation::rates(const State& y) const
{
    const long double a = y[0], b = y[1], c = y[2];
    return {(inertia_[1] - inertia_[2]) * b * c / inertia_[0],
            (inertia_[2] - inertia_[0]) * c * a / inertia_[1],
            (inertia_[0] - inertia_[1]) * a * b / inertia_[2],
            0.5L * (-y[4] * a - y[5] * b - y[6] * c),
            0.5L * (y[3] * a + y[5] * c - y[6] * b),
            0.5L * (y[3] * b + y[6] * a - y[4] * c),
            0.5L * (y[3] * c + y[4] * b - y[5] * a)};
}

FreeRotation::State FreeRotation::advanced(const State& y, long double h) const
{
    const auto moved = [&y](const State& k, long double s)
    {
        State out;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = y[i] + s * k[i];
        return out;
    };
    const State k1 = rates(y);
    const State k2 = rates(moved(k1, h / 2));
    const State k3 = rates(moved(k2, h / 2));
    const State k4 = rates(moved(k3, h));
    State out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = y[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return out;
}

Quat FreeRotation::attitude(double t) const
{
    const auto index = std::min(static_cast<std::size_t>(t * kKept), kept_.size() - 1);
    State y = kept_[index];
    constexpr int kPieces = 200;
    const long double rest = static_cast<long double>(t) - static_cast<long double>(index) / kKept;
    if (rest != 0)
        for (int i = 0; i < kPieces; ++i) y = advanced(y, rest / kPieces);
    return {static_cast<double>(y[3]), static_cast<double>(y[4]), static_cast<double>(y[5]), static_cast<double>(y[6])};
}

double bouncing_height(double drop, double g, double t)
{
    const double fall = std::sqrt(2 * drop / g);
    const double s = std::remainder(t, 2 * fall);  // from the nearest top, as at the start
    return drop - 0.5 * g * s * s;
}

double damped_oscillation(double mass, double stiffness, double damping, double x0, double t)
{
    const double decay = damping / (2 * mass);
    const double w = std::sqrt(stiffness / mass - decay * decay);
    return x0 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
}

}  // namespace plab::peers
