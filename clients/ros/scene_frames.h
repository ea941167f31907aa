/// The frames of a scene: one for each body and each shaft, all relative to the world.
///
/// Frames have pLab's axes (right-handed, metres, as REP 103 wants them); a body's frame is B, a shaft's turns with it about z.
#pragma once

#include <unordered_map>
#include <vector>

#include "link/catalogue.h"
#include "ros/names.h"

namespace plab::ros
{

struct SceneFrame
{
    std::string id, name;  ///< of the component, in ROS
    std::uint32_t handle = 0;
    bool is_shaft = false, is_static = false;
    Pose pose;  ///< X_WB as the catalogue has it; X_WA of a shaft's axle
};

class SceneFrames
{
public:
    void rebuild(const link::CatalogueContents& scene, NameTable& names);

    const std::vector<SceneFrame>& all() const { return frames_; }
    const SceneFrame* find(std::uint32_t handle) const;
    const SceneFrame* find_id(const std::string& id) const;

private:
    std::vector<SceneFrame> frames_;  ///< by id
    std::unordered_map<std::uint32_t, std::size_t> by_handle_;
};

/// The pose of a shaft's frame that has turned by `angle` about its axle.
Pose turned(const Pose& axle, double angle);

}  // namespace plab::ros
