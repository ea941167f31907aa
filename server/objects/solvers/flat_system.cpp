#include "flat_system.h"

#include <algorithm>
#include <cmath>

namespace plab::solvers
{

void FlatSystem::read(std::span<double> y) const
{
    const auto x = system_->coordinates();
    const auto u = system_->speeds();
    for (std::size_t i = 0; i < places_; ++i) y[i] = x[i];
    for (std::size_t i = 0; i < speeds_; ++i) y[places_ + i] = u[i];
}

void FlatSystem::write(std::span<const double> y)
{
    const auto x = system_->coordinates();
    const auto u = system_->speeds();
    for (std::size_t i = 0; i < places_; ++i) x[i] = y[i];
    for (std::size_t i = 0; i < speeds_; ++i) u[i] = y[places_ + i];
}

void FlatSystem::evaluate(double t, std::span<const double> y, std::span<double> f, double weight)
{
    write(y);
    system_->evaluate(t, weight);
    ++evaluations_;
    const auto dx = system_->coordinate_rates();
    const auto du = system_->speed_rates();
    for (std::size_t i = 0; i < places_; ++i) f[i] = dx[i];
    for (std::size_t i = 0; i < speeds_; ++i) f[places_ + i] = du[i];
}

void FlatSystem::sizes(std::span<const double> y, std::span<const double> f, double h, std::span<double> sizes) const
{
    const auto length = [](std::span<const double> v, std::size_t i) { return std::hypot(v[i], v[i + 1], v[i + 2]); };
    const std::size_t in_bodies = 6 * system_->body_count();
    for (std::size_t i = 0; i < places_; i += i < in_bodies ? 3 : 1)
    {
        if (i >= in_bodies)
        {
            sizes[i] = std::fmax(std::fabs(y[i]), std::fabs(h * f[i]));
            continue;
        }
        sizes[i] = sizes[i + 1] = sizes[i + 2] = std::fmax(length(y, i), std::fabs(h) * length(f, i));
    }
    for (std::size_t i = 0; i < speeds_; i += i < in_bodies ? 3 : 1)
    {
        const std::size_t k = places_ + i;
        if (i >= in_bodies)
            sizes[k] = std::fmax(std::fabs(y[k]), is_quantity(k) ? std::fabs(h * f[k]) : 0.0);
        else
            sizes[k] = sizes[k + 1] = sizes[k + 2] = length(y, k);
    }
}

void FlatSystem::units(std::span<double> units) const
{
    std::fill(units.begin(), units.end(), 1.0);
    for (std::size_t b = 0; b < system_->body_count(); ++b)
    {
        const RigidMember member = system_->rigid(b);
        if (member.needle) continue;
        const Mat3& inertia = member.inertia_B;
        const double largest = std::max({inertia(0, 0), inertia(1, 1), inertia(2, 2)});
        for (std::size_t i = 0; i < 3; ++i) units[places_ + 6 * b + 3 + i] = largest;
    }
}

double FlatSystem::norm(std::span<const double> e, std::span<const double> scale)
{
    double most = 0;
    for (std::size_t i = 0; i < e.size(); ++i)
    {
        const double part = std::fabs(e[i]) / scale[i];
        if (!(part <= most)) most = part;  // keeps a NaN
    }
    return most;
}

void FlatSystem::scales(const Tolerance& tolerance, std::span<const double> units, std::span<const double> sizes, std::span<double> out)
{
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = tolerance.absolute * units[i] + tolerance.relative * sizes[i];
}

bool all_finite(std::span<const double> y)
{
    return std::all_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace plab::solvers
