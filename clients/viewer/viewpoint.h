/// The view: a camera of the scene, a fixed position, a circle around the scene, or tracking of an object.
#pragma once

#include "viewer/options.h"
#include "viewer/scene_model.h"

namespace plab::view
{

class Viewpoint
{
public:
    explicit Viewpoint(ViewChoice choice) : choice_(std::move(choice)) {}

    /// The view of `items` at this state. `camera` (of the scene) overrides the options, unless empty. Errors: no such camera,
    /// no such object.
    Result<render::View> find(const SceneModel& model, const std::vector<render::Item>& items, const State& state,
                              const std::string& camera = {});

private:
    Result<render::View> start(const SceneModel& model, const std::string& camera) const;
    void circle(render::View& view, double time) const;

    ViewChoice choice_;
    std::optional<render::View> of_everything_;  ///< as the scene was first seen: a view recomputed at each step would jitter
    std::uint64_t run_ = 0;
    std::optional<Vec3> tracked_;  ///< last place of the tracked object
};

}  // namespace plab::view
