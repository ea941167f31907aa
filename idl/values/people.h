/// The values of plab.idl that concern people: what they send, and the forces on them. values.h includes this.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "idl/values/members.h"
#include "plab/vector.h"

namespace plab::wire
{

using ClientId = std::array<std::uint8_t, 16>;

struct ViewerSample
{
    ClientId client{};
    std::string viewer;
    std::uint64_t number = 0;
    std::int64_t stamp_ns = 0;
    Vec3 position, direction{1, 0, 0}, up{0, 0, 1}, velocity;
    double field_of_view = 0.7, width = 1280, height = 720;
};
PLAB_MEMBERS(ViewerSample, client, viewer, number, stamp_ns, position, direction, up, velocity, field_of_view, width, height)

struct UserSample
{
    ClientId client{};
    std::string user;
    std::uint64_t number = 0;
    std::int64_t stamp_ns = 0;
    Vec3 position;
    Quat orientation;
    Vec3 linear_velocity, angular_velocity;
    double grip = 0;
    std::uint32_t buttons = 0;
};
PLAB_MEMBERS(UserSample, client, user, number, stamp_ns, position, orientation, linear_velocity, angular_velocity, grip, buttons)

struct UserForce
{
    std::string user;
    ClientId client{};
    std::uint64_t number = 0, skipped = 0;
    Vec3 force, torque;
};
PLAB_MEMBERS(UserForce, user, client, number, skipped, force, torque)

struct Forces
{
    std::uint64_t run = 0, sequence_number = 0;
    std::int64_t step = 0;
    double time = 0;
    std::vector<UserForce> entries;
};
PLAB_MEMBERS(Forces, run, sequence_number, step, time, entries)

}  // namespace plab::wire
