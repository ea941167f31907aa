/// From where to look: a camera of the scene, a place, around in a circle, or after an object.
#pragma once

#include "viewer/options.h"
#include "viewer/scene_model.h"

namespace plab::view
{

class Viewpoint
{
public:
    explicit Viewpoint(ViewChoice choice) : choice_(std::move(choice)) {}

    /// The view of `items` at this state. `camera` (of the scene) stands above what the options chose, unless empty.
    /// Errors: no such camera, no such object.
    Result<render::View> find(const SceneModel& model, const std::vector<render::Item>& items, const State& state,
                              const std::string& camera = {});

private:
    Result<render::View> start(const SceneModel& model, const std::string& camera) const;
    void circle(render::View& view, double time) const;

    ViewChoice choice_;
    std::optional<render::View> of_everything_;  ///< as the scene was first seen: a view that follows each step would shake
    std::uint64_t run_ = 0;
    std::optional<Vec3> tracked_;  ///< last place of the tracked object
};

}  // namespace plab::view
