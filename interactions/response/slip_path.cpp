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
constexpr int kMaxSteps = 20000;

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

Vector8 derivative(const SlipLaw& law, const Vector8& y)
{
    const SlipRates r = law.rates(y[kCos], y[kSin]);
    const double slip = y[kSlip];
    return {-y[kSin] * r.turn,
            y[kCos] * r.turn,
            slip * r.grow,
            slip * r.normal,
            slip * y[kNormal],
            -law.friction * slip * y[kCos],
            -law.friction * slip * y[kSin],
            slip};
}

struct Step
{
    Vector8 y;
    double error = 0;  // in units of the tolerance
};

/// Dormand and Prince, J. Comp. Appl. Math. 6 (1980), RK5(4)7M.
Step advance(const SlipLaw& law, const Vector8& y, double h, const Vector8& unit)
{
    constexpr double a[6][6] = {{1.0 / 5},
                                {3.0 / 40, 9.0 / 40},
                                {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    constexpr double e[7] = {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    std::array<Vector8, 7> k;
    k[0] = derivative(law, y);
    Vector8 next = y;
    for (std::size_t stage = 0; stage < 6; ++stage)
    {
        for (std::size_t i = 0; i < 8; ++i)
        {
            double sum = 0;
            for (std::size_t j = 0; j <= stage; ++j) sum += a[stage][j] * k[j][i];
            next[i] = y[i] + h * sum;
        }
        k[stage + 1] = derivative(law, next);
    }
    Step out{next, 0};
    for (std::size_t i = 0; i < 8; ++i)
    {
        double sum = 0;
        for (std::size_t j = 0; j < 7; ++j) sum += e[j] * k[j][i];
        out.error = std::max(out.error, std::fabs(h * sum) / (kTolerance * unit[i]));
    }
    const double norm = std::hypot(next[kCos], next[kSin]);
    out.y[kCos] /= norm, out.y[kSin] /= norm;
    return out;
}

/// Magnitudes relative to which errors are measured.
Vector8 units_of(const SlipLaw& law, const ImpactState& state)
{
    const double speed = length(state.u);
    const double impulse = speed / law.K(2, 2);
    return {1, 1, speed, speed, speed * impulse, impulse, impulse, impulse};
}

/// < 0 before the end of the phase.
double before_end(bool compressing, double goal, const Vector8& y) { return compressing ? y[kNormal] : y[kWork] - goal; }

/// The state at the end of the phase within a step of length h (Illinois variant of false position).
Vector8 find_end(const SlipLaw& law, const Vector8& y, double h, const Vector8& unit, bool compressing, double goal)
{
    double lo = 0, hi = h;
    double f_lo = before_end(compressing, goal, y), f_hi = before_end(compressing, goal, advance(law, y, h, unit).y);
    Vector8 best = advance(law, y, h, unit).y;
    for (int i = 0; i < 100 && hi - lo > 1e-16 * h && f_hi != 0; ++i)
    {
        const double middle = lo + (hi - lo) * (f_lo / (f_lo - f_hi));
        if (!(middle > lo && middle < hi)) break;
        const Vector8 trial = advance(law, y, middle, unit).y;
        const double f = before_end(compressing, goal, trial);
        if (f < 0)
            lo = middle, f_lo = f, f_hi *= 0.5;
        else
            hi = middle, f_hi = f, f_lo *= 0.5, best = trial;
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
    double h = 0.1 / law.scale();
    for (int i = 0; i < kMaxSteps; ++i)
    {
        const Step step = advance(law, y, h, unit);
        const double factor = std::clamp(0.9 * std::pow(std::max(step.error, 1e-10), -0.2), 0.2, 4.0);
        if (step.error > 1)
        {
            h *= factor;
            continue;
        }
        if (before_end(compressing, goal, step.y) >= 0)
        {
            store(find_end(law, y, h, unit, compressing, goal), state);
            return SlipEnd::Phase;
        }
        y = step.y;
        store(y, state);
        if (y[kSlip] <= kStopped * slip) return SlipEnd::Stopped;
        if (std::fabs(law.rates(y[kCos], y[kSin]).turn) <= kStraight * law.scale()) return SlipEnd::Straight;
        h *= factor;
    }
    return SlipEnd::Stopped;
}

}  // namespace plab::response
