#include "ros/scene_frames.h"

#include <algorithm>
#include <cmath>

namespace plab::ros
{

void SceneFrames::rebuild(const link::CatalogueContents& scene, NameTable& names)
{
    frames_.clear(), by_handle_.clear();
    for (const auto& [id, object] : scene.objects)
    {
        by_handle_.emplace(object.handle, frames_.size());
        frames_.push_back({id,
                           names.name_of(id),
                           object.handle,
                           link::is_shaft(object),
                           object.motion == "static",
                           {object.position, object.orientation}});
    }
}

const SceneFrame* SceneFrames::find(std::uint32_t handle) const
{
    const auto at = by_handle_.find(handle);
    return at == by_handle_.end() ? nullptr : &frames_[at->second];
}

const SceneFrame* SceneFrames::find_id(const std::string& id) const
{
    const auto at =
        std::lower_bound(frames_.begin(), frames_.end(), id, [](const SceneFrame& f, const std::string& of) { return f.id < of; });
    return at == frames_.end() || at->id != id ? nullptr : &*at;
}

Pose turned(const Pose& axle, double angle) { return {axle.p, axle.q * Quat{std::cos(0.5 * angle), 0, 0, std::sin(0.5 * angle)}}; }

}  // namespace plab::ros
