#include "impact_law.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "slip_path.h"

namespace plab::response
{
namespace
{
/// Fraction of the approach speed: slip below this is a rounding error.
constexpr double kNoSlip = 1e-14;
/// Fraction of K_nn: where joints leave a point one line to move along and friction holds it there, the normal impulse does less.
constexpr double kJammed = 1e-9;
/// Fraction of K: a slip direction that turns more slowly counts as constant.
constexpr double kStraightSlip = 1e-14;

/// Builds up the impulse piece by piece until restitution has returned its work.
class Collision
{
public:
    Collision(const Mat3& K, const Vec3& u, double friction, double restitution) : law_{K, friction}, restitution_(restitution)
    {
        state_.u = u;
    }
    ImpactResult run();

private:
    void slide();
    void stick_or_restart();
    /// Applies normal impulse along a constant direction of force, until the phase ends or `to_stick` (an amount of normal
    /// impulse) is reached. Returns whether it was reached.
    bool go_straight(const Vec3& force, double to_stick);
    void finish_phase();
    double to_phase_end(double rate) const;

    SlipLaw law_;
    double restitution_;
    ImpactState state_;
    bool compressing_ = true, done_ = false;
    double goal_ = 0;  // J, work to be returned in restitution
};

ImpactResult Collision::run()
{
    const double slip = std::hypot(state_.u.x, state_.u.y);
    if (slip > kNoSlip * std::fabs(state_.u.z))
        slide();
    else
        state_.u.x = state_.u.y = 0;
    if (!done_) stick_or_restart();
    return {state_.impulse, state_.u, state_.series};
}

/// Normal impulse until u_n = 0, or until the rest of the work is returned, with du_n/dJ_n = rate.
double Collision::to_phase_end(double rate) const
{
    const double u_n = state_.u.z;
    if (compressing_) return rate > 0 ? std::max(0.0, -u_n / rate) : HUGE_VAL;
    const double left = goal_ - state_.work;
    const double square = u_n * u_n + 2 * rate * left;
    if (square < 0) return HUGE_VAL;
    const double sum = u_n + std::sqrt(square);
    return sum > 0 ? 2 * left / sum : HUGE_VAL;
}

void Collision::finish_phase()
{
    if (!compressing_)
    {
        done_ = true;
        return;
    }
    compressing_ = false;
    goal_ = -restitution_ * restitution_ * state_.work;
    state_.work = 0;
    state_.u.z = 0;
    done_ = !(goal_ > 0);
}

bool Collision::go_straight(const Vec3& force, double to_stick)
{
    Vec3 rate = law_.K * force;
    if (std::fabs(rate.z) <= kJammed * law_.K(2, 2)) rate.z = 0;
    while (!done_)
    {
        const double to_end = to_phase_end(rate.z);
        const double amount = std::min(to_stick, to_end);
        if (!std::isfinite(amount))
        {
            done_ = true;  // impossible: energy would grow without bound
            return false;
        }
        state_.work += amount * (state_.u.z + 0.5 * rate.z * amount);
        state_.u += rate * amount;
        state_.impulse += force * amount;
        if (to_stick <= to_end) return true;
        to_stick -= amount;
        finish_phase();
    }
    return false;
}

void Collision::slide()
{
    while (!done_)
    {
        const double slip = std::hypot(state_.u.x, state_.u.y);
        const double c = state_.u.x / slip, s = state_.u.y / slip;
        const SlipRates rates = law_.rates(c, s);
        if (std::fabs(rates.turn) <= kStraightSlip * law_.scale())
        {
            const double to_stick = rates.grow < 0 ? -slip / rates.grow : HUGE_VAL;
            if (!go_straight({-law_.friction * c, -law_.friction * s, 1}, to_stick)) return;
            state_.u.x = state_.u.y = 0;
            return;
        }
        switch (follow_slip(law_, compressing_, goal_, state_))
        {
            case SlipEnd::Phase:
                finish_phase();
                break;
            case SlipEnd::Stopped:
                state_.u.x = state_.u.y = 0;
                return;
            case SlipEnd::Straight:
                break;
        }
    }
}

void Collision::stick_or_restart()
{
    const Vec3 hold = law_.holding_force();
    if (std::hypot(hold.x, hold.y) <= law_.friction * (1 + 1e-12))
    {
        go_straight(hold, HUGE_VAL);
        if (state_.u.x != 0 || state_.u.y != 0) state_.u.x = state_.u.y = 0;
        return;
    }
    const auto [c, s] = law_.leaving_direction();
    go_straight({-law_.friction * c, -law_.friction * s, 1}, HUGE_VAL);
}

/// Solves in coordinates whose first axis lies along the slip: the rounding is then the same if the whole scene is rotated.
ImpactResult solve_along_slip(const Mat3& K, const Vec3& u, double friction, double restitution)
{
    const double slip = std::hypot(u.x, u.y);
    const double c = slip > 0 ? u.x / slip : 1, s = slip > 0 ? u.y / slip : 0;
    const Mat3 R{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    ImpactResult r = Collision(R * K * transposed(R), {slip, 0, u.z}, friction, restitution).run();
    return {transposed_times(R, r.impulse), transposed_times(R, r.velocity), r.series};
}
}  // namespace

ImpactResult solve_impact(const Mat3& K, const Vec3& u, double friction, double restitution)
{
    if (friction > 0) return solve_along_slip(K, u, friction, restitution);
    const double j = -(1 + restitution) * u.z / K(2, 2);
    return {{0, 0, j}, {u.x + K(0, 2) * j, u.y + K(1, 2) * j, -restitution * u.z}};
}

}  // namespace plab::response
