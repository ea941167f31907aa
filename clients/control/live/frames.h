/// Motion of objects, from the newest frame.
#pragma once

#include <map>

#include "control/console/json.h"

namespace plab::cli
{

struct Motion
{
    bool is_shaft = false;
    Vec3 position, linear_velocity, angular_velocity;  ///< of a body
    Quat orientation;
    double angle = 0, speed = 0;  ///< of a shaft
};

struct Frame
{
    std::uint64_t run = 0, revision = 0, number = 0;
    std::int64_t step = 0, stamp_ns = 0;
    double time = 0;
    std::map<std::uint32_t, Motion> motions;  ///< by handle
};

Frame frame_of(const plab_v2_Frame& sample);
/// The next frame that arrives within `timeout`; empty if none does (a paused server sends none).
std::optional<Frame> next_frame(const link::Session& session, link::Seconds timeout);

Json json_of(const Motion& m);

}  // namespace plab::cli
