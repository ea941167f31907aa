/// Setting a field of a live component, for requests and scripts alike: checked, prepared, and with what depends on it.
#pragma once

#include <set>
#include <string>

#include "world/world.h"

namespace plab::simulation
{

/// Sets a param or state after checking the declared rules, runs Prepare where a parameter changed, keeps the motion that
/// the author sees, prepares what wears a changed shape, and lifts a quarantine. Adds to `prepared` whoever was prepared.
/// On error the component may hold the new value already: the caller restores (a transaction) or sets the old one again.
Result<void> set_field(world::World& world, std::uint32_t component, const std::string& name, Value value,
                       std::set<std::uint32_t>& prepared);

/// How one body moves, as its author sees it, and what that hangs on.
struct BodyMotion
{
    bool is_body = false;
    Motion motion = Motion::Static;
    Vec3 center_B;
    Mat3 inertia_B;
    Value orientation, position, angular_velocity, linear_velocity;
};
BodyMotion motion_of(const world::World& world, std::uint32_t component);

/// New mass properties may move the centre of mass or change what moves at all; pose and velocity of the frame that the
/// author sees stay. Where nothing of that changed, no bit is touched.
void keep_motion(world::World& world, std::uint32_t component, const BodyMotion& before);

/// A shape's size is the mass of the bodies that wear it.
Result<void> prepare_dependents(world::World& world, std::uint32_t component, std::set<std::uint32_t>& prepared);

}  // namespace plab::simulation
