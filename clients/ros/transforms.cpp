#include "ros/transforms.h"

namespace plab::ros
{

msg::Transform& TransformMessage::add(const SceneFrame& frame, const Pose& pose, const msg::Time& stamp)
{
    msg::Transform& out = transforms_.emplace_back();
    out.header = {stamp, wire::text(kWorldFrame)};
    out.child_frame_id = wire::text(frame.name);
    out.transform = {vector_of(pose.p), quaternion_of(pose.q)};
    return out;
}

const msg::Transforms& TransformMessage::moving(const SceneFrames& frames, const plab_v2_Frame& frame)
{
    transforms_.clear();
    const msg::Time stamp = time_of(frame.time);
    for (const plab_v2_BodyState& body : wire::items(frame.bodies))
        if (const SceneFrame* known = frames.find(body.handle); known != nullptr && !known->is_static) add(*known, pose_of(body), stamp);
    for (const plab_v2_ShaftState& shaft : wire::items(frame.shafts))
        if (const SceneFrame* known = frames.find(shaft.handle); known != nullptr && !known->is_static)
            add(*known, turned(known->pose, shaft.angle), stamp);
    show(message_.transforms, transforms_);
    return message_;
}

const msg::Transforms& TransformMessage::fixed(const SceneFrames& frames, double time)
{
    transforms_.clear();
    for (const SceneFrame& frame : frames.all())
        if (frame.is_static) add(frame, frame.pose, time_of(time));
    show(message_.transforms, transforms_);
    return message_;
}

}  // namespace plab::ros
