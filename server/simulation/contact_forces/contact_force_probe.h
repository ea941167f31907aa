/// Measures the force law of one contact by itself: stiffness, damping, and the largest depth that it will reach.
///
/// The law belongs to a plugin and is a black box, so its derivatives are taken by finite differences. The probe evaluates it on copies
/// of the two bodies, so that nothing in the scene changes.
#pragma once

#include <array>

#include "simulation/contacts/contact_force_pair.h"
#include "world/world.h"

namespace plab::simulation
{

/// Runs the Phase::Touch commands of a response. Contact::impulse comes out as the force on b, N.
void run_force_laws(world::World& world, std::uint32_t response, const StepContext& context, std::span<Contact> contacts, Bodies& bodies,
                    Wrenches& wrenches);

class ForceProbe
{
public:
    /// Copies the two bodies of `contact` at their present poses, at rest.
    /// `size`: m, the smaller body's radius; `h`: s, the step.
    void take(const Bodies& bodies, const Contact& contact, double size, double h);
    /// Force on b along the normal, N, at a depth (m) and a closing speed (m/s).
    double normal_force(world::World& world, std::uint32_t response, double depth, double closing);
    /// m: the depth at which the spring force is zero, near that of the contact.
    double open_depth(world::World& world, std::uint32_t response);
    /// m: the largest depth that an impact with the speed `closing` (m/s) reaches if it starts at `open_depth` (m).
    double peak_depth(world::World& world, std::uint32_t response, double open_depth, double closing);
    /// J: what the spring stores at a depth (m), if its rest_depth (m) is this.
    double stored(world::World& world, std::uint32_t response, double depth, double rest_depth);
    /// m: the rest_depth with which the spring stores `energy` (J) at a depth (m): 0 where it would store less even then.
    double rest_depth_that_stores(world::World& world, std::uint32_t response, double depth, double energy);
    /// Frequencies and decay rate at a depth (m).
    ContactRates rates(world::World& world, std::uint32_t response, double depth);
    /// N/m of the stiction spring at a depth; 0 without friction.
    double stiction(world::World& world, std::uint32_t response, double depth);
    /// 1/kg along the normal.
    double mobility() const { return mobility_[2]; }

private:
    Vec3 force(world::World& world, std::uint32_t response, double depth, const Vec3& stretch, const Vec3& velocity);

    Contact contact_;
    std::array<Vec3, 3> axes_;  // two along the surface, then the normal
    std::array<double, 3> mobility_{};
    double share_a_ = 0;
    double speed_ = 0;  // m/s, small compared to the body's size per step
    double size_ = 0;   // m, over which rounding of positions counts
    Bodies bodies_;
    Shafts shafts_;
    Wrenches wrenches_;
};

}  // namespace plab::simulation
