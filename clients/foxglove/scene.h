/// The scene as foxglove::SceneUpdate and foxglove::FrameTransforms: each object is an entity of exact shapes in a frame of its own, which
/// moves; an object that cannot move is in the world's frame.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "idl/plab.h"
#include "link/catalogue.h"
#include "plab/vector.h"

namespace plab::foxglove
{

/// CDR of scene updates, each of about a megabyte at most, unless one object is larger.
using SceneUpdates = std::vector<std::string>;

/// What a scene is drawn by: a part of the catalogue.
struct DrawnScene
{
    std::map<std::string, link::Object> objects;
    std::map<std::string, link::Shape> shapes;
};

/// Everything, after everything that was there is removed. `time`: ns.
SceneUpdates whole_scene(const DrawnScene& scene, std::uint64_t time);
/// What is new, other or gone; empty: nothing.
SceneUpdates scene_changes(const DrawnScene& before, const DrawnScene& now, std::uint64_t time);

/// Frames of moving objects, in the world.
class FrameWriter
{
public:
    void use(const std::map<std::string, link::Object>& objects);
    /// CDR; objects that the frame lacks, or that are of another run, are left out.
    std::string transforms(const plab_v2_Frame& frame, std::uint64_t time) const;
    /// As the catalogue has them, for a server that is paused and sends no frames.
    std::string transforms(const std::map<std::string, link::Object>& objects, std::uint64_t time) const;

private:
    struct Mover
    {
        std::string id;
        std::uint64_t run = 0;
        Pose axle;  ///< of a shaft, at angle 0
    };
    std::unordered_map<std::uint32_t, Mover> movers_;  ///< by handle
};

}  // namespace plab::foxglove
