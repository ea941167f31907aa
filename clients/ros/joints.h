/// joint_states: the position and speed of every hinge, slider and shaft, and its effort where something drives it.
///
/// Positions are made of the same frame as tf, because the server sends outputs of interactions four times a second only:
///   hinge   angle of frame_b in frame_a about their z                 rad, whole turns counted from frame to frame
///   slider  n . (p_b - p_a) + what it had travelled                   m
///   shaft   its angle                                                 rad
/// Effort is what motors and springs between the same bodies exert along that coordinate, as of the last metrics.
#pragma once

#include <optional>

#include "ros/messages.h"
#include "ros/scene_frames.h"

namespace plab::ros
{

class JointMessage
{
public:
    void rebuild(const link::CatalogueContents& scene, const SceneFrames& frames, NameTable& names);

    /// Valid until the next one. `metrics` may be null: then no effort is known.
    const msg::JointState& of(const plab_v2_Frame& frame, const link::Metrics* metrics);
    std::size_t count() const { return joints_.size(); }
    /// Whether metrics contribute anything.
    bool has_drives() const { return has_drives_; }

private:
    enum class Kind : std::uint8_t
    {
        Hinge,
        Slider,
        Shaft,
    };
    /// A body of a joint, or the world.
    struct Side
    {
        std::optional<std::uint32_t> handle;  ///< none: it does not move
        Pose pose;                            ///< then this is where it is
        Quat frame;                           ///< z along the axis
        Vec3 point;
    };
    struct Drive
    {
        std::string id;
        bool is_motor = false;
    };
    struct Joint
    {
        std::string name;
        Kind kind = Kind::Hinge;
        Side a, b;
        double travelled = 0;                   ///< m, of a slider when its points were read
        double angle = 0, time = 0, speed = 0;  ///< of a hinge in the last frame
        std::vector<Drive> drives;
    };
    struct Coordinate
    {
        double position = 0, speed = 0;
        Vec3 axis;  ///< in W
    };

    std::optional<Joint> joint_of(const link::Interaction& joint, const link::CatalogueContents& scene, const SceneFrames& frames) const;
    void find_drives(const link::CatalogueContents& scene);
    std::optional<Coordinate> coordinate_of(Joint& joint, const plab_v2_Frame& frame) const;
    std::optional<Coordinate> between(Joint& joint, double time) const;

    std::map<std::string, Joint> joints_;  ///< by id
    bool has_drives_ = false;
    std::unordered_map<std::uint32_t, const plab_v2_BodyState*> bodies_;  ///< of the frame
    std::unordered_map<std::uint32_t, const plab_v2_ShaftState*> shafts_;
    std::vector<char*> names_;
    std::vector<double> positions_, speeds_, efforts_;
    msg::JointState message_{};
};

}  // namespace plab::ros
