#include "cone_solver.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace plab::response
{
namespace
{
/// Number of directions in a scan.
constexpr int kSamples = 128;
constexpr double kStep = 6.283185307179586 / kSamples;

/// A contact that slides along the direction (c, s): j = j_n (-mu c, -mu s, 1), with j_n such that u_n = b.
class Sliding
{
public:
    Sliding(const Mat3& K, const Vec3& r, double least, double friction) : K_(K), r_(r), least_(least), mu_(friction) {}

    std::optional<Vec3> impulse(double c, double s) const
    {
        const double stiffness = K_(2, 2) - mu_ * (K_(2, 0) * c + K_(2, 1) * s);
        if (!(stiffness > 0)) return {};  // more pressure would close it faster (Painleve)
        const double j = (least_ - r_.z) / stiffness;
        return Vec3{-mu_ * c * j, -mu_ * s * j, j};
    }
    /// The relative velocity that results; its tangential part must lie along (c, s).
    Vec3 relative_velocity(const Vec3& j) const { return r_ + K_ * j; }

    /// Fixed-point iteration: slide along the slip direction that results. Converges at once where K does not couple directions.
    std::optional<Vec3> settle(double c, double s) const;
    /// A solution near the direction of the last sweep.
    std::optional<Vec3> find_near(double c, double s) const;
    /// Scans all directions for one in which the resulting slip lies along the direction itself.
    std::optional<Vec3> scan() const;

private:
    /// Slip perpendicular to the direction, m/s; NaN if sliding in this direction is impossible.
    double miss(double angle) const;
    std::optional<Vec3> along(double angle) const;
    /// Rounding error of a slip, which is the difference of r and K j, m/s.
    double rounding(const Vec3& j) const { return 4e-16 * (length(r_) + length(K_ * j)); }

    const Mat3& K_;
    const Vec3& r_;
    double least_, mu_;
};

std::optional<Vec3> Sliding::settle(double c, double s) const
{
    constexpr int kTrials = 30;
    constexpr double kSettled = 1e-15;
    for (int i = 0; i < kTrials; ++i)
    {
        const auto j = impulse(c, s);
        if (!j) return {};
        const Vec3 u = relative_velocity(*j);
        const double speed = std::hypot(u.x, u.y);
        if (!(speed > 0)) return {};
        const double turn = (c * u.y - s * u.x) / speed;
        if (c * u.x + s * u.y > 0 && std::fabs(turn) <= std::max(kSettled, rounding(*j) / speed)) return j;
        c = u.x / speed, s = u.y / speed;
    }
    return {};
}

double Sliding::miss(double angle) const
{
    const double c = std::cos(angle), s = std::sin(angle);
    const auto j = impulse(c, s);
    if (!j) return NAN;
    const Vec3 u = relative_velocity(*j);
    return c * u.y - s * u.x;
}

std::optional<Vec3> Sliding::along(double angle) const
{
    const double c = std::cos(angle), s = std::sin(angle);
    const auto j = impulse(c, s);
    if (!j) return {};
    const Vec3 u = relative_velocity(*j);
    return c * u.x + s * u.y > 0 ? j : std::nullopt;
}

/// False position (Illinois variant) between two neighbours of the last direction.
std::optional<Vec3> Sliding::find_near(double c, double s) const
{
    constexpr int kTrials = 40;
    const double angle = std::atan2(s, c);
    double lo = angle - kStep, hi = angle + kStep, f_lo = miss(lo), f_hi = miss(hi);
    if (std::isnan(f_lo) || std::isnan(f_hi) || (f_lo < 0) == (f_hi < 0)) return {};
    for (int i = 0; i < kTrials; ++i)
    {
        const double next = lo - f_lo * ((hi - lo) / (f_hi - f_lo)), f = miss(next);
        if (std::isnan(f)) return {};
        const auto j = along(next);
        if (f == 0 || (j && std::fabs(f) <= rounding(*j))) return j;
        if ((f < 0) == (f_hi < 0))
            f_lo *= 0.5;
        else
            lo = hi, f_lo = f_hi;
        hi = next, f_hi = f;
    }
    return {};
}

std::optional<Vec3> Sliding::scan() const
{
    for (int i = 0; i < kSamples; ++i)
    {
        double lo = i * kStep, hi = (i + 1) * kStep;
        const double f_lo = miss(lo), f_hi = miss(hi);
        if (std::isnan(f_lo) || std::isnan(f_hi) || (f_lo < 0) == (f_hi < 0)) continue;
        for (int k = 0; k < 60; ++k)
        {
            const double middle = 0.5 * (lo + hi);
            ((miss(middle) < 0) == (f_lo < 0) ? lo : hi) = middle;
        }
        if (const auto j = along(lo)) return j;
    }
    return {};
}
}  // namespace

Vec3 solve_cone(const Mat3& K, const Vec3& r, double least, double friction, const Vec3& last)
{
    if (r.z >= least) return {};
    if (friction == 0) return {0, 0, (least - r.z) / K(2, 2)};
    const Vec3 stick = inverse(K) * (Vec3{0, 0, least} - r);
    const double hold = std::hypot(stick.x, stick.y);
    if (stick.z > 0 && hold <= friction * stick.z) return stick;
    const Sliding sliding(K, r, least, friction);
    if (const double slip = std::hypot(r.x, r.y); slip > 0)
        if (const auto j = sliding.settle(r.x / slip, r.y / slip)) return *j;
    // Friction opposes the slip.
    if (last.x != 0 || last.y != 0)
        if (const auto j = sliding.find_near(-last.x, -last.y)) return *j;
    if (const auto j = sliding.scan()) return *j;
    // No sliding direction fits: the sticking impulse projected onto the cone keeps the contact from closing.
    const double normal = std::max(stick.z, (least - r.z) / K(2, 2));
    const double share = hold > 0 ? std::min(1.0, friction * normal / hold) : 0.0;
    return {stick.x * share, stick.y * share, normal};
}

ConeResult solve_cones(std::span<ConeContact> contacts, ContactVelocities& velocities, double tolerance, int max_sweeps,
                       const Interruption* interruption)
{
    ConeResult out;
    while (out.sweeps < max_sweeps && !out.converged && !(interruption && interruption->due()))
    {
        ++out.sweeps;
        double largest = 0;
        for (ConeContact& c : contacts)
        {
            const Vec3 before = c.impulse;
            const Mat3& K = velocities.K(c.contact);
            const Vec3 r = velocities.at(c.contact) - K * before;
            c.impulse = solve_cone(K, r, c.least, c.friction, before);
            const Vec3 change = c.impulse - before;
            if (change == Vec3{}) continue;
            const Vec3 kick = K * change;
            velocities.apply(c.contact, change, c.impulse.z > 0 ? c.least : r.z);
            largest = std::max({largest, std::fabs(kick.x), std::fabs(kick.y), std::fabs(kick.z)});
        }
        out.converged = largest <= tolerance;
    }
    for (const ConeContact& c : contacts) out.residual = std::max(out.residual, c.least - velocities.at(c.contact).z);
    return out;
}

namespace
{

struct Outcome
{
    Vec3 impulse, velocity;
};

/// What share of the way from the first outcome to the second gains no energy, sum of j . (u + u') / 2, which is a convex parabola of it.
double share_without_gain(std::span<const Outcome> first, std::span<const Outcome> second, std::span<const Vec3> before)
{
    double a = 0, b = 0, c = 0;
    for (std::size_t k = 0; k < first.size(); ++k)
    {
        const Vec3 j = first[k].impulse, dj = second[k].impulse - j;
        const Vec3 u = before[k] + first[k].velocity, du = second[k].velocity - first[k].velocity;
        a += dot(dj, du), b += dot(dj, u) + dot(j, du), c += dot(j, u);
    }
    if (!std::isfinite(a) || !std::isfinite(b) || !(a > 0) || c > 0) return 0;
    const double root = std::sqrt(b * b - 4 * a * c);
    return std::clamp(b > 0 ? -2 * c / (b + root) : (root - b) / (2 * a), 0.0, 1.0);
}

}  // namespace

ConeResult reduce_friction(std::span<ConeContact> contacts, std::span<const Vec3> before, ContactVelocities& velocities, double tolerance,
                           int max_sweeps, const Interruption* interruption)
{
    const auto outcome = [&](const ConeContact& c) { return Outcome{c.impulse, velocities.at(c.contact)}; };
    std::vector<Outcome> rough, smooth;
    std::vector<double> friction;
    for (ConeContact& c : contacts)
    {
        rough.push_back(outcome(c)), friction.push_back(c.friction);
        c.friction = 0, c.impulse = {};
    }
    velocities.put_back();
    ConeResult out = solve_cones(contacts, velocities, tolerance, max_sweeps, interruption);
    for (const ConeContact& c : contacts) smooth.push_back(outcome(c));
    const double share = share_without_gain(smooth, rough, before);
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        ConeContact& c = contacts[k];
        const Vec3 more = (rough[k].impulse - c.impulse) * share;
        c.friction = friction[k];
        if (!(share > 0) || more == Vec3{}) continue;
        c.impulse += more;
        velocities.apply(c.contact, more, velocities.at(c.contact).z + (velocities.K(c.contact) * more).z);
    }
    return out;
}

double energy_gained(std::span<const ConeContact> contacts, std::span<const Vec3> before, const ContactVelocities& velocities)
{
    double gain = 0, size = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        const ConeContact& c = contacts[k];
        gain += 0.5 * dot(c.impulse, before[k] + velocities.at(c.contact));
        size += length(c.impulse) * length(before[k]);
    }
    if (gain <= 1e-12 * size) return 0;
    return std::isfinite(gain) ? gain : HUGE_VAL;
}

}  // namespace plab::response
