/// Motion of bodies through a step of time stepping: forces kick the velocities, contacts and joints apply impulses, then poses move.
///
/// Between impulses a body rotates as in torque-free motion, by the closed-form solution of Euler's equations (plab/free_rotation.h). The
/// rotation with the momentum L conserves the kinetic energy, T(L, q1) = T(L, q0), for any step size. Rotating with a momentum other than
/// the body's own would change the component of L along the body's thin axis, where the inertia I is small, and the energy L^2 / (2 I) of
/// that component makes simulations of slender bodies explode.
#pragma once

#include <span>
#include <vector>

#include "plab/parts.h"
#include "simulation/systems/group_system.h"

namespace plab::simulation
{

/// Rotates body b for h (s) with its angular momentum minus `lacking` (N m s, W); the stored momentum does not change.
void turn_freely(Bodies& bodies, std::uint32_t b, const Vec3& lacking, double h);

/// Bodies, or contact points, of which one thread moves so many at once: some microseconds of work.
inline constexpr std::size_t kKickedPart = 128;

class KickedBodies
{
public:
    struct Speeds
    {
        Vec3 velocity;  ///< m/s
        Vec3 momentum;  ///< N m s, W; for needles the angular velocity in B, rad/s: speeds 3..5 of a GroupSystem
        Vec3 spin;      ///< rad/s, W
    };

    /// Changes velocities by the forces over h (s). `members`: indices into system.bodies(). Of two kicks without a move in between only
    /// the last one counts. `workers`: threads to share the work with; null: none.
    void kick(GroupSystem& system, Bodies& bodies, std::span<const std::uint32_t> members, double h, Workers* workers = nullptr);
    /// Moves with the present velocities; h < 0 undoes such a move.
    void move(double h) { move_some(0, members_.size(), h); }
    /// The same for members `begin` to `end`; several threads may move different ones.
    void move_some(std::size_t begin, std::size_t end, double h);
    /// Moves with the mean of the present velocities and those before the kick: exact for constant forces. If rotating with the mean
    /// momentum would create energy, as after an impact, bodies rotate with the momentum after it instead. `follows_turns`: the impulses
    /// have counted on what the rotation does to the spins, as those of contacts without joints do; then bodies rotate as nearly with the
    /// mean as creates no energy, which is nearly the mean where contacts take what the rotation gains (a disc that rolls).
    /// Returns J: work of contacts and joints since the kick, including the energy error of the rotation.
    double move_mean(double h, bool follows_turns = false);

    /// The present velocities, or the means of those before the kick and now.
    Speeds speeds(std::size_t member, bool mean) const;
    /// W: power of the forces of the kick at these velocities.
    double power(std::size_t member, const Speeds& speeds) const;
    /// J: work of contacts and joints on the members since the kick, which is the change of kinetic energy minus the work of the forces at
    /// the mean velocities.
    double work_of_contacts(double h) const;

private:
    struct Before
    {
        Speeds speeds;
        double energy = 0;  ///< J
    };
    struct Kept
    {
        Quat orientation;
        Vec3 spin;
        double energy = 0;  ///< J
        Vec3 lacking;       ///< N m s, W: what the mean momentum is less than the body's own
    };
    /// J: of bodies that gain energy by their rotation, and of those that lose some.
    struct Gain
    {
        double gained = 0, lost = 0;
        void add(double more) { (more > 0 ? gained : lost) += more; }
        double sum() const { return gained + lost; }
    };
    double gain_of(std::size_t member) const;
    void balance_turns(double h, double taken, double rounding, Gain& turned);
    Gain turn_again(double h, double share, bool gaining);
    std::uint32_t body(std::size_t member) const { return system_->bodies()[members_[member]]; }

    GroupSystem* system_ = nullptr;
    Bodies* bodies_ = nullptr;
    std::span<const std::uint32_t> members_;
    std::vector<Before> before_;
    std::vector<Kept> kept_;
};

}  // namespace plab::simulation
