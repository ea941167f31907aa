/// Setting a field of a live component, for requests and for scripts: the value is checked, and the component and its dependents are
/// prepared.
#pragma once

#include <set>
#include <string>

#include "simulation/requests/requests.h"
#include "world/world.h"

namespace plab::simulation
{

/// The value that a request gives a field: parsed from a text by the field's own rules, or checked. Whole numbers may be given for reals.
Result<Value> value_for(const Field& field, const GivenValue& given);

/// Sets a param or state after checking the declared rules. Runs Prepare if a parameter changed, preserves the motion that the author of
/// the scene sees, prepares the bodies that use a changed shape, and ends a quarantine. Adds every prepared component to `prepared`. On
/// error the component may already hold the new value; the caller restores it (as a transaction does) or sets the old value again.
Result<void> set_field(world::World& world, std::uint32_t component, const std::string& name, Value value,
                       std::set<std::uint32_t>& prepared);

/// The motion of one body as the author of the scene sees it, and the properties on which that depends.
struct BodyMotion
{
    bool is_body = false;
    Motion motion = Motion::Static;
    Vec3 center_B;
    Mat3 inertia_B;
    Value orientation, position, angular_velocity, linear_velocity;
};
BodyMotion motion_of(const world::World& world, std::uint32_t component);

/// New mass properties may move the centre of mass, or change whether the body is dynamic; the pose and velocity of the frame that the
/// author sees stay the same. Where none of these properties changed, no bit is touched.
void keep_motion(world::World& world, std::uint32_t component, const BodyMotion& before);

/// Prepares the bodies that use a shape, because its size determines their mass.
Result<void> prepare_dependents(world::World& world, std::uint32_t component, std::set<std::uint32_t>& prepared);

}  // namespace plab::simulation
