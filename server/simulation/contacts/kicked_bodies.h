/// How bodies move through a step of time stepping: kicked by forces, pushed by contacts and joints, then moved.
///
/// Between impulses a body turns as torque-free motion does, by Euler's equations in closed form (plab/free_rotation.h). The momentum
/// L that it turns with keeps its kinetic energy, T(L, q1) = T(L, q0), whatever the step. A turn with another momentum than the
/// body's leaves L with another part along the body's thin axis, and L^2 / (2 I) of that part is what slender bodies explode by.
#pragma once

#include <span>
#include <vector>

#include "simulation/systems/group_system.h"

namespace plab::simulation
{

/// Turns body b for h (s) with its angular momentum less `lacking` (N m s, W); its own momentum stays what it is.
void turn_freely(Bodies& bodies, std::uint32_t b, const Vec3& lacking, double h);

class KickedBodies
{
public:
    struct Speeds
    {
        Vec3 velocity;  ///< m/s
        Vec3 momentum;  ///< N m s, W; or the spin in B of needles: speeds 3..5 of a GroupSystem
        Vec3 spin;      ///< rad/s, W
    };

    /// Changes speeds by what forces do in h (s). `members`: indices into system.bodies(). What is kicked twice without a move
    /// between was kicked once: the last time.
    void kick(GroupSystem& system, Bodies& bodies, std::span<const std::uint32_t> members, double h);
    /// Moves with the present speeds; h < 0 takes such a move back.
    void move(double h);
    /// Moves with the mean of the present speeds and those before the kick: exact for constant forces. Where what contacts and
    /// joints did was an impact, with which that would make energy, bodies turn with the momentum after it.
    /// J: what contacts and joints did since the kick, with what the turn made of it.
    double move_mean(double h);

    /// Now, or the means of those before the kick and now.
    Speeds speeds(std::size_t member, bool mean) const;
    /// W: of the forces of the kick at these speeds.
    double power(std::size_t member, const Speeds& speeds) const;
    /// J, since the kick: what contacts and joints did to the members, the forces' work on the mean way left out.
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
    };
    std::uint32_t body(std::size_t member) const { return system_->bodies()[members_[member]]; }

    GroupSystem* system_ = nullptr;
    Bodies* bodies_ = nullptr;
    std::span<const std::uint32_t> members_;
    std::vector<Before> before_;
    std::vector<Kept> kept_;
};

}  // namespace plab::simulation
