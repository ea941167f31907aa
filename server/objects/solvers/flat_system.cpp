#include "flat_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

namespace
{

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Of central differences over d and d/2; the extrapolated one is then right to about the square of it.
constexpr double kAgreement = 1e-5;

/// The increment as the system will see it: y + d is rounded.
double representable(double y, double d)
{
    const volatile double moved = y + d;
    return moved - y;
}

class FineColumn
{
public:
    FineColumn(FlatSystem& system, const JacobianPoint& at, std::size_t column, SquareMatrix<double>& out)
        : system_(system), at_(at), column_(column), out_(out)
    {
    }

    void find()
    {
        double d = length();
        if (is_linear(d)) return;
        double best = std::numeric_limits<double>::infinity();
        for (int level = 0; level < 8; ++level, d /= 16)
        {
            const double difference = extrapolated(d);
            if (!(difference < best)) continue;
            best = difference;
            for (std::size_t i = 0; i < system_.size(); ++i) out_(i, column_) = at_.other[i];
            if (best < kAgreement) break;
        }
    }

private:
    /// The first increment: as long as the motion may well be.
    double length() const
    {
        const double least = std::max(at_.sizes[column_], (system_.is_quantity(column_) ? 1e-6 : 1e-2) * at_.units[column_]);
        if (column_ < system_.places()) return std::min(least, system_.uses_rotations() ? 0.1 : 1.0);
        if (system_.is_quantity(column_)) return least;
        // Stiff springs carry large forces, whose rounding would drown a small change by dampers: the speed that the force
        // reaches within a radian of its oscillation. Columns of places are known by now.
        double stiffness = 0;
        for (std::size_t j = 0; j < system_.places(); ++j) stiffness = std::fmax(stiffness, std::fabs(out_(column_, j)));
        return std::max(least, std::min(std::fabs(at_.f[column_]) * at_.h, std::fabs(at_.f[column_]) / std::sqrt(stiffness)));
    }

    void evaluate_at(double d, std::span<double> f)
    {
        std::copy(at_.y.begin(), at_.y.end(), at_.work.begin());
        at_.work[column_] += d;
        system_.evaluate(at_.t, at_.work, f);
    }

    /// Slopes over d and d/2 agree to rounding: fills the column.
    bool is_linear(double d)
    {
        d = representable(at_.y[column_], d);
        const double half = representable(at_.y[column_], 0.5 * d);
        evaluate_at(d, at_.slope);
        evaluate_at(half, at_.other);
        bool linear = true;
        for (std::size_t i = 0; i < system_.size(); ++i)
        {
            const double whole = (at_.slope[i] - at_.f[i]) / d, part = (at_.other[i] - at_.f[i]) / half;
            const double noise = 16 * kEpsilon * (std::fabs(at_.f[i]) + std::fabs(at_.slope[i])) / half;
            linear = linear && std::fabs(whole - part) <= 1e-11 * std::fabs(whole) + noise;
            out_(i, column_) = whole;
        }
        return linear;
    }

    /// Central differences over d and d/2, extrapolated into `other`; returns how far they are apart, relative to the largest
    /// of its kind (rates of places, rates of speeds).
    double extrapolated(double d)
    {
        d = representable(at_.y[column_], d);
        const double half = representable(at_.y[column_], 0.5 * d);
        central(d);
        std::copy(at_.other.begin(), at_.other.end(), wide_.begin());
        central(half);
        double worst = 0;
        for (const auto& [from, to] : {std::pair{std::size_t{0}, system_.places()}, std::pair{system_.places(), system_.size()}})
        {
            double largest = 0, apart = 0;
            for (std::size_t i = from; i < to; ++i)
            {
                largest = std::fmax(largest, std::fabs(at_.other[i]));
                apart = std::fmax(apart, std::fabs(at_.other[i] - wide_[i]));
            }
            if (apart > 0) worst = std::fmax(worst, largest > 0 ? apart / largest : 1.0);
        }
        for (std::size_t i = 0; i < system_.size(); ++i) at_.other[i] += (at_.other[i] - wide_[i]) / 3;
        return all_finite(at_.other) ? worst : std::numeric_limits<double>::infinity();
    }

    void central(double d)
    {
        evaluate_at(d, at_.other);
        evaluate_at(-d, at_.slope);
        for (std::size_t i = 0; i < system_.size(); ++i) at_.other[i] = (at_.other[i] - at_.slope[i]) / (2 * d);
    }

    FlatSystem& system_;
    const JacobianPoint& at_;
    std::size_t column_;
    SquareMatrix<double>& out_;
    std::span<double> wide_ = at_.wide;
};

}  // namespace

void rough_jacobian(FlatSystem& system, const JacobianPoint& at, double relative, SquareMatrix<double>& out)
{
    const std::size_t n = system.size();
    out.resize(n);
    std::copy(at.y.begin(), at.y.end(), at.work.begin());
    for (std::size_t j = 0; j < n && !system.interrupted(); ++j)
    {
        const double least = system.is_quantity(j) ? 1e5 * at.absolute : 1e-3 * at.units[j];
        const double d = representable(at.y[j], relative * std::max(at.sizes[j], least));
        at.work[j] = at.y[j] + d;
        system.evaluate(at.t, at.work, at.slope);
        at.work[j] = at.y[j];
        for (std::size_t i = 0; i < n; ++i) out(i, j) = (at.slope[i] - at.f[i]) / d;
    }
}

void fine_column(FlatSystem& system, const JacobianPoint& at, std::size_t column, SquareMatrix<double>& out)
{
    FineColumn(system, at, column, out).find();
}

}  // namespace plab::solvers
