#include "simulation/contacts/kicked_bodies.h"

#include <algorithm>
#include <array>

#include "plab/free_rotation.h"
#include "plab/rotation.h"
#include "plab/symmetric.h"
#include "simulation/contacts/turn_four.h"

namespace plab::simulation
{
namespace
{

/// turn_freely() for a body with one moment of inertia, which turns about its angular momentum at a constant rate.
void turn_about_momentum(Bodies& bodies, std::uint32_t b, const Vec3& momentum, double h)
{
    if (momentum == Vec3{} || !is_finite(momentum)) return;
    const Quat turn = exp_rotation(momentum * (bodies.inverse_inertia_B[b](0, 0) * h));
    bodies.orientation[b] = normalized(turn * bodies.orientation[b]);
    bodies.refresh_spin(b);
}

Vec3 scaled(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace

void turn_freely(Bodies& bodies, std::uint32_t b, const Vec3& lacking, double h)
{
    if (is_isotropic(bodies.inverse_inertia_B[b])) return turn_about_momentum(bodies, b, bodies.angular_momentum[b] - lacking, h);
    const Quat start = bodies.orientation[b];
    const bool needle = bodies.needle[b] != 0;
    if (!needle)
    {
        const Vec3 momentum_B = rotate_back(start, bodies.angular_momentum[b] - lacking);
        if (turns_slowly(bodies.inverse_inertia_B[b], momentum_B, h))
        {
            if (momentum_B == Vec3{}) return;
            bodies.orientation[b] = normalized(start * slow_turn(bodies.inverse_inertia_B[b], momentum_B, h));
            bodies.refresh_spin(b);
            return;
        }
    }
    const RigidMember member{start, bodies.inertia_B[b], bodies.inverse_inertia_B[b], bodies.mass[b], needle};
    const PrincipalAxes principal = principal_axes(member);
    const auto to_P = [&](const Vec3& v_W) { return transposed_times(principal.axes, rotate_back(start, v_W)); };
    // For a needle the state is its angular velocity: the smallest moment of inertia times it keeps all digits, whereas the momentum in W
    // would lose them.
    const Vec3 own = needle ? scaled(principal.moment, to_P(bodies.angular_velocity[b])) : to_P(bodies.angular_momentum[b]);
    const Vec3 lack = to_P(lacking), turning = own - lack;
    if (turning == Vec3{} || !is_finite(turning)) return;
    const FreeTop top(principal, turning);
    const Quat turn_P = top.turn(h);
    const Vec3 axis_B = principal.axes * Vec3{turn_P.x, turn_P.y, turn_P.z};
    bodies.orientation[b] = normalized(start * Quat{turn_P.w, axis_B.x, axis_B.y, axis_B.z});
    if (needle)
    {
        const Vec3 momentum = top.momentum(h) + rotate_back(turn_P, lack);
        bodies.angular_velocity[b] = rotate(bodies.orientation[b], principal.axes * scaled(principal.reciprocal, momentum));
    }
    bodies.refresh_spin(b);
}

void KickedBodies::kick(GroupSystem& system, Bodies& bodies, std::span<const std::uint32_t> members, double h, Workers* workers)
{
    system_ = &system, bodies_ = &bodies, members_ = members;
    before_.resize(members.size());
    for_parts(workers, members.size(), kKickedPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t k = begin; k < end; ++k)
                  {
                      before_[k] = {speeds(k, false), bodies.kinetic_energy(body(k))};
                      system.kick(members[k], h);
                  }
              });
}

KickedBodies::Speeds KickedBodies::speeds(std::size_t k, bool mean) const
{
    const std::uint32_t b = body(k);
    const Vec3& spin = bodies_->angular_velocity[b];
    Speeds now{bodies_->velocity[b], bodies_->needle[b] != 0 ? rotate_back(bodies_->orientation[b], spin) : bodies_->angular_momentum[b],
               spin};
    if (!mean) return now;
    const Speeds& then = before_[k].speeds;
    return {(then.velocity + now.velocity) * 0.5, (then.momentum + now.momentum) * 0.5, (then.spin + now.spin) * 0.5};
}

double KickedBodies::power(std::size_t k, const Speeds& speeds) const
{
    return bodies_->mass[body(k)] * dot(system_->acceleration(members_[k]), speeds.velocity) +
           dot(system_->torque(members_[k]), speeds.spin);
}

double KickedBodies::work_of_contacts(double h) const
{
    double sum = 0;
    for (std::size_t k = 0; k < members_.size(); ++k)
        sum += bodies_->kinetic_energy(body(k)) - before_[k].energy - power(k, speeds(k, true)) * h;
    return sum;
}

void KickedBodies::move_some(std::size_t begin, std::size_t end, double h)
{
    for (std::size_t k = begin; k < end; ++k) bodies_->position[body(k)] += bodies_->velocity[body(k)] * h;
    std::size_t k = begin;
    for (; k + 4 <= end; k += 4)
    {
        const std::array<std::uint32_t, 4> four{body(k), body(k + 1), body(k + 2), body(k + 3)};
        if (turn_four(*bodies_, four, h)) continue;
        for (const std::uint32_t b : four) turn_freely(*bodies_, b, {}, h);
    }
    for (; k < end; ++k) turn_freely(*bodies_, body(k), {}, h);
}

double KickedBodies::move_mean(double h, bool follows_turns)
{
    constexpr double kRounding = 1e-13;
    const double taken = -work_of_contacts(h);
    double size = 0;
    Gain turned;
    kept_.clear();
    for (std::size_t k = 0; k < members_.size(); ++k)
    {
        const std::uint32_t b = body(k);
        kept_.push_back({bodies_->orientation[b], bodies_->angular_velocity[b], bodies_->kinetic_energy(b), {}});
        const Speeds mean = speeds(k, true);
        bodies_->position[b] += mean.velocity * h;
        kept_[k].lacking = bodies_->needle[b] != 0
                               ? rotate(bodies_->orientation[b], bodies_->inertia_B[b] * (speeds(k, false).momentum - mean.momentum))
                               : bodies_->angular_momentum[b] - mean.momentum;
        turn_freely(*bodies_, b, kept_[k].lacking, h);
        turned.add(gain_of(k));
        size += before_[k].energy + kept_[k].energy;
    }
    if (follows_turns) balance_turns(h, taken, kRounding * size, turned);
    if (turned.sum() > std::max(taken, 0.0) + kRounding * size) turned = turn_again(h, 0, true);
    return turned.sum() - taken;
}

/// What the rotation gains and what contacts take from the bodies would be the same in exact motion without slip. Where more is gained, or
/// less is lost than contacts have given, the share of the mean momentum is changed; what bodies gain is nearly in proportion to it.
void KickedBodies::balance_turns(double h, double taken, double rounding, Gain& turned)
{
    constexpr int kMostTries = 4;
    constexpr double kMostShare = 1.25;  // beyond it contacts have not given because of the rotation: a moving floor has
    double share = 1;
    for (int tries = 0; tries < kMostTries; ++tries)
    {
        const double limit = std::max(taken, 0.0);
        const bool gains = turned.sum() > limit + rounding;
        const bool gives = taken < -rounding && turned.sum() > taken + rounding && turned.gained == 0 && turned.lost < 0;
        if (!gains && !gives) return;
        share *= gains ? (limit - turned.lost) / turned.gained : taken / turned.lost;
        if (gains ? !(limit - turned.lost > rounding) : !(share < kMostShare)) break;
        turned = turn_again(h, share, gains);
    }
}

/// J: what the rotation has added to a body's energy.
double KickedBodies::gain_of(std::size_t k) const { return bodies_->kinetic_energy(body(k)) - kept_[k].energy; }

/// Rotates bodies anew, all or those that have gained energy, with a share of what their mean momentum differs from their own.
KickedBodies::Gain KickedBodies::turn_again(double h, double share, bool gaining)
{
    Gain turned;
    for (std::size_t k = 0; k < members_.size(); ++k)
    {
        const std::uint32_t b = body(k);
        if (gaining && !(gain_of(k) > 0))
        {
            turned.add(gain_of(k));
            continue;
        }
        bodies_->orientation[b] = kept_[k].orientation, bodies_->angular_velocity[b] = kept_[k].spin;
        bodies_->refresh_spin(b);
        turn_freely(*bodies_, b, kept_[k].lacking * share, h);
        if (share > 0) turned.add(gain_of(k));
    }
    return turned;
}

}  // namespace plab::simulation
