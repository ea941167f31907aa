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

    /// Fixed-point iteration: slide along the slip direction that results. Converges at once where K does not couple directions; otherwise
    /// Newton's method ends it.
    std::optional<Vec3> settle(double c, double s) const;
    /// Turns from (c, s) towards the slip until that lies on the other side of the direction, and closes in on where it lies along it.
    std::optional<Vec3> close_in(double c, double s) const;
    /// Scans all directions for one in which the resulting slip lies along the direction itself.
    std::optional<Vec3> scan() const;

private:
    /// rad: Newton's step to the direction (c, s) + turn (-s, c) for which the slip is along the direction itself. `u`: with the impulse j.
    double newton_turn(double c, double s, const Vec3& j, const Vec3& u) const;
    /// Slip perpendicular to the direction, m/s; NaN if sliding in this direction is impossible.
    double miss(double c, double s) const;
    double miss(double angle) const { return miss(std::cos(angle), std::sin(angle)); }
    std::optional<Vec3> along(double angle) const;
    /// Rounding error of a slip, which is the difference of r and K j, m/s.
    double rounding(const Vec3& j) const { return 4e-16 * (length(r_) + length(K_ * j)); }

    const Mat3& K_;
    const Vec3& r_;
    double least_, mu_;
};

/// The slip across the direction d is g = d x u(d), with u = r + j_n (K_n - mu K_t d) and j_n = (b - r_n) / (K_nn - mu K_nt . d).
double Sliding::newton_turn(double c, double s, const Vec3& j, const Vec3& u) const
{
    const double stiffness = K_(2, 2) - mu_ * (K_(2, 0) * c + K_(2, 1) * s), softer = mu_ * (K_(2, 1) * c - K_(2, 0) * s);
    // Derivatives with respect to the angle: of d it is (-s, c), of j_n it is j_n `grows`.
    const double grows = softer / stiffness;
    const Vec3 dj{grows * j.x + mu_ * s * j.z, grows * j.y - mu_ * c * j.z, grows * j.z};
    const Vec3 du = K_ * dj;
    return (s * u.x - c * u.y) / (c * du.y - s * du.x - (c * u.x + s * u.y));
}

std::optional<Vec3> Sliding::settle(double c, double s) const
{
    constexpr int kTrials = 10, kFixedPoint = 2;
    constexpr double kSettled = 1e-15, kMostTurn = 0.25;
    for (int i = 0; i < kTrials; ++i)
    {
        const auto j = impulse(c, s);
        if (!j) return {};
        const Vec3 u = relative_velocity(*j);
        const double speed = std::sqrt(u.x * u.x + u.y * u.y);
        if (!(speed > 0)) return {};
        const double turn = (c * u.y - s * u.x) / speed;
        const bool along = c * u.x + s * u.y > 0;
        if (along && std::fabs(turn) <= std::max(kSettled, rounding(*j) / speed)) return j;
        if (!along && i >= kFixedPoint) return {};  // the slip jumps to and fro
        const double newton = i >= kFixedPoint ? newton_turn(c, s, *j, u) : kMostTurn;
        if (std::fabs(newton) < kMostTurn)
        {
            const double x = c - newton * s, y = s + newton * c, size = std::sqrt(x * x + y * y);
            c = x / size, s = y / size;
        }
        else
            c = u.x / speed, s = u.y / speed;
    }
    return {};
}

double Sliding::miss(double c, double s) const
{
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

/// Newton's method between bounds that hold the direction. Directions are (1 - t^2, 2 t) / (1 + t^2) from one that was passed.
std::optional<Vec3> Sliding::close_in(double c, double s) const
{
    constexpr int kTurns = 8, kTrials = 60;
    constexpr double kEighth = 0.7071067811865476, kHalfOfEighth = 0.41421356237309505;  // the cosine of 45 deg, the tangent of half of it
    double from = miss(c, s), sign = from < 0 ? -1 : 1, next = from;
    double x = c, y = s;
    for (int i = 0; i < kTurns && next * sign >= 0; ++i)
    {
        c = x, s = y;
        x = kEighth * (c - sign * s), y = kEighth * (s + sign * c);
        next = miss(x, y);
    }
    if (!(next * sign < 0)) return {};
    double low = 0, high = kHalfOfEighth, t = 0.5 * high;
    for (int i = 0; i < kTrials; ++i)
    {
        const double size = 1 / (1 + t * t), cosine = (1 - t * t) * size, sine = 2 * t * size * sign;
        x = cosine * c - sine * s, y = cosine * s + sine * c;
        const auto j = impulse(x, y);
        if (!j) return {};
        const Vec3 u = relative_velocity(*j);
        const double across = x * u.y - y * u.x;
        const bool last = std::fabs(across) <= rounding(*j) || !(t > low && t < high);
        if (last) return x * u.x + y * u.y > 0 ? j : std::nullopt;
        (across * sign > 0 ? low : high) = t;
        t += 0.5 * (1 + t * t) * sign * newton_turn(x, y, *j, u);
        if (!(t > low && t < high)) t = 0.5 * (low + high);
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
    const Vec3 near = last.x != 0 || last.y != 0 ? Vec3{-last.x, -last.y, 0} : Vec3{r.x, r.y, 0};
    if (const double size = length(near); size > 0)
        if (const auto j = sliding.close_in(near.x / size, near.y / size)) return *j;
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
