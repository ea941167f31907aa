#include "slip_path.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace plab::response
{
namespace
{
constexpr double kStraight = 1e-14;
constexpr double kStopped = 1e-13;  // fraction of the slip at the start
constexpr double kTolerance = 1e-13;
constexpr int kMaxSteps = 2000;

/// Direction of slip c, s; then slip speed, u_n, work, and the impulses along t1, t2, n.
using Vector8 = std::array<double, 8>;
enum : std::size_t
{
    kCos,
    kSin,
    kSlip,
    kNormal,
    kWork,
    kJ1,
    kJ2,
    kJn,
};

constexpr std::size_t kOrder = 16;
using Series = std::array<double, kOrder + 1>;

/// Coefficient k of the product of two power series.
double product(const Series& a, const Series& b, std::size_t k)
{
    double sum = 0;
    for (std::size_t i = 0; i <= k; ++i) sum += a[i] * b[k - i];
    return sum;
}

/// The solution as a power series in tau about a state. The right-hand sides are polynomials, so its coefficients follow one from another.
class Expansion
{
public:
    Expansion(const SlipLaw& law, const Vector8& y);
    Vector8 at(double tau) const;
    double at(double tau, std::size_t component) const;
    /// The step at which the last terms are at the tolerance.
    double step(const Vector8& unit) const;

private:
    std::array<Series, 8> of_;
};

Expansion::Expansion(const SlipLaw& law, const Vector8& y)
{
    const Mat3& K = law.K;
    const double mu = law.friction;
    Series &c = of_[kCos], &s = of_[kSin], &slip = of_[kSlip], &normal = of_[kNormal];
    for (std::size_t i = 0; i < y.size(); ++i) of_[i][0] = y[i];
    Series f1, f2, turn, grow, rate;
    for (std::size_t k = 0; k < kOrder; ++k)
    {
        const double of_constant = k == 0 ? 1 : 0, share = 1 / static_cast<double>(k + 1);
        f1[k] = of_constant * K(0, 2) - mu * (K(0, 0) * c[k] + K(0, 1) * s[k]);
        f2[k] = of_constant * K(1, 2) - mu * (K(1, 0) * c[k] + K(1, 1) * s[k]);
        rate[k] = of_constant * K(2, 2) - mu * (K(2, 0) * c[k] + K(2, 1) * s[k]);
        turn[k] = product(c, f2, k) - product(s, f1, k), grow[k] = product(c, f1, k) + product(s, f2, k);
        c[k + 1] = -share * product(s, turn, k), s[k + 1] = share * product(c, turn, k);
        slip[k + 1] = share * product(slip, grow, k), normal[k + 1] = share * product(slip, rate, k);
        of_[kWork][k + 1] = share * product(slip, normal, k);
        of_[kJ1][k + 1] = -mu * share * product(slip, c, k), of_[kJ2][k + 1] = -mu * share * product(slip, s, k);
        of_[kJn][k + 1] = share * slip[k];
    }
}

double Expansion::at(double tau, std::size_t component) const
{
    double sum = 0;
    for (std::size_t k = kOrder + 1; k-- > 0;) sum = sum * tau + of_[component][k];
    return sum;
}

Vector8 Expansion::at(double tau) const
{
    Vector8 y;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = at(tau, i);
    const double norm = std::hypot(y[kCos], y[kSin]);
    y[kCos] /= norm, y[kSin] /= norm;
    return y;
}

double Expansion::step(const Vector8& unit) const
{
    double last = 0, before = 0;
    for (std::size_t i = 0; i < unit.size(); ++i)
    {
        last = std::max(last, std::fabs(of_[i][kOrder]) / (kTolerance * unit[i]));
        before = std::max(before, std::fabs(of_[i][kOrder - 1]) / (kTolerance * unit[i]));
    }
    constexpr double kLeast = 1e-300;
    return std::min(std::pow(std::max(last, kLeast), -1.0 / kOrder), std::pow(std::max(before, kLeast), -1.0 / (kOrder - 1)));
}

/// Magnitudes relative to which errors are measured.
Vector8 units_of(const SlipLaw& law, const ImpactState& state)
{
    const double speed = length(state.u);
    const double impulse = speed / law.K(2, 2);
    return {1, 1, speed, speed, speed * impulse, impulse, impulse, impulse};
}

/// < 0 before the end of the phase.
double before_end(bool compressing, double goal, const Expansion& series, double tau)
{
    return compressing ? series.at(tau, kNormal) : series.at(tau, kWork) - goal;
}

/// The end of the phase within a step of length h (Illinois variant of false position).
double find_end(const Expansion& series, double h, bool compressing, double goal)
{
    double lo = 0, hi = h, best = h;
    double f_lo = before_end(compressing, goal, series, 0), f_hi = before_end(compressing, goal, series, h);
    for (int i = 0; i < 100 && hi - lo > 1e-16 * h && f_hi != 0; ++i)
    {
        const double middle = lo + (hi - lo) * (f_lo / (f_lo - f_hi));
        if (!(middle > lo && middle < hi)) break;
        const double f = before_end(compressing, goal, series, middle);
        if (f < 0)
            lo = middle, f_lo = f, f_hi *= 0.5;
        else
            hi = best = middle, f_hi = f, f_lo *= 0.5;
    }
    return best;
}

void store(const Vector8& y, ImpactState& state)
{
    state.u = {y[kSlip] * y[kCos], y[kSlip] * y[kSin], y[kNormal]};
    state.work = y[kWork];
    state.impulse = {y[kJ1], y[kJ2], y[kJn]};
}
}  // namespace

SlipRates SlipLaw::rates(double c, double s) const
{
    const double f1 = K(0, 2) - friction * (K(0, 0) * c + K(0, 1) * s);
    const double f2 = K(1, 2) - friction * (K(1, 0) * c + K(1, 1) * s);
    return {c * f1 + s * f2, c * f2 - s * f1, K(2, 2) - friction * (K(2, 0) * c + K(2, 1) * s)};
}

double SlipLaw::scale() const { return friction * (std::fabs(K(0, 0)) + std::fabs(K(1, 1))) + std::fabs(K(0, 2)) + std::fabs(K(1, 2)); }

Vec3 SlipLaw::holding_force() const
{
    const double det = K(0, 0) * K(1, 1) - K(0, 1) * K(1, 0);
    return {-(K(1, 1) * K(0, 2) - K(0, 1) * K(1, 2)) / det, -(K(0, 0) * K(1, 2) - K(1, 0) * K(0, 2)) / det, 1};
}

std::pair<double, double> SlipLaw::leaving_direction() const
{
    constexpr int kSamples = 256;
    constexpr double kStep = 6.283185307179586 / kSamples;
    const auto turn = [&](double angle) { return rates(std::cos(angle), std::sin(angle)).turn; };
    for (int i = 0; i < kSamples; ++i)
    {
        double lo = i * kStep, hi = (i + 1) * kStep;
        if ((turn(lo) < 0) == (turn(hi) < 0)) continue;
        const bool rising = turn(hi) >= 0;
        for (int k = 0; k < 60; ++k)
        {
            const double middle = 0.5 * (lo + hi);
            ((turn(middle) >= 0) == rising ? hi : lo) = middle;
        }
        if (rates(std::cos(lo), std::sin(lo)).grow > 0) return {std::cos(lo), std::sin(lo)};
    }
    // No such direction exists, so friction holds after all. The direction of the force that drives the slip is the nearest
    // choice.
    const double size = std::hypot(K(0, 2), K(1, 2));
    return {K(0, 2) / size, K(1, 2) / size};
}

SlipEnd follow_slip(const SlipLaw& law, bool compressing, double goal, ImpactState& state)
{
    const double slip = std::hypot(state.u.x, state.u.y);
    const Vector8 unit = units_of(law, state);
    Vector8 y{state.u.x / slip, state.u.y / slip, slip, state.u.z, state.work, state.impulse.x, state.impulse.y, state.impulse.z};
    for (int i = 0; i < kMaxSteps; ++i)
    {
        const Expansion series(law, y);
        ++state.series;
        const double h = series.step(unit);
        if (before_end(compressing, goal, series, h) >= 0)
        {
            store(series.at(find_end(series, h, compressing, goal)), state);
            return SlipEnd::Phase;
        }
        y = series.at(h);
        store(y, state);
        if (y[kSlip] <= kStopped * slip) return SlipEnd::Stopped;
        if (std::fabs(law.rates(y[kCos], y[kSin]).turn) <= kStraight * law.scale()) return SlipEnd::Straight;
    }
    return SlipEnd::Stopped;
}

}  // namespace plab::response
