/// visualization_marker_array: the exact shapes of all bodies, each in the frame of its body, so that RViz moves them with tf.
#pragma once

#include "ros/messages.h"
#include "ros/scene_frames.h"

namespace plab::ros
{

class MarkerMessage
{
public:
    /// All markers of the scene, after one that removes those of before. Valid until the next one.
    const msg::MarkerArray& of(const link::CatalogueContents& scene, const SceneFrames& frames);
    /// Of the last message: differs if anything in it does.
    std::uint64_t fingerprint() const { return fingerprint_; }

private:
    void add_shape(const SceneFrame& frame, const link::Shape& shape, const Vec3& color);
    msg::Marker& add(const SceneFrame& frame, std::int32_t type, const Pose& pose, const Vec3& scale, const Vec3& color);
    void add_mesh(const SceneFrame& frame, const link::Shape& shape, const Vec3& color);
    void note(const void* bytes, std::size_t size);

    std::vector<msg::Marker> markers_;
    wire::SequenceMemory memory_;
    msg::MarkerArray message_{};
    std::int32_t next_id_ = 0;
    std::uint64_t fingerprint_ = 0;
};

}  // namespace plab::ros
