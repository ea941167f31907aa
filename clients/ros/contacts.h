/// contacts: what touched in a step, as ros_gz_interfaces/msg/Contacts.
#pragma once

#include "ros/messages.h"
#include "ros/scene_frames.h"

namespace plab::ros
{

class ContactMessage
{
public:
    /// Contacts that began, bounced, came to rest or ended in one step of `dt` seconds. A contact that ended has no positions. Valid until
    /// the next one.
    const msg::Contacts& of(const plab_v2_Collisions& collisions, double dt, const SceneFrames& frames);

private:
    void fill(const plab_v2_CollisionInfo& from, double dt, const SceneFrames& frames, msg::Contact& to);

    std::vector<msg::Contact> contacts_;
    wire::SequenceMemory memory_;
    msg::Contacts message_{};
};

}  // namespace plab::ros
