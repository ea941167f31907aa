/// tf and tf_static: the poses of all frames in the world.
#pragma once

#include "ros/messages.h"
#include "ros/scene_frames.h"

namespace plab::ros
{

/// Makes one message at a time, which is valid until the next one.
class TransformMessage
{
public:
    /// Of all that a frame has: bodies and shafts that are not static.
    const msg::Transforms& moving(const SceneFrames& frames, const plab_v2_Frame& frame);
    /// Of what never moves.
    const msg::Transforms& fixed(const SceneFrames& frames, double time);

private:
    msg::Transform& add(const SceneFrame& frame, const Pose& pose, const msg::Time& stamp);

    std::vector<msg::Transform> transforms_;
    msg::Transforms message_{};
};

}  // namespace plab::ros
