/// Converts a moment to a picture: scene, view, renderer.
#pragma once

#include "viewer/moment_buffer.h"
#include "viewer/options.h"
#include "viewer/scene_model.h"

namespace plab::view
{

/// The view: a camera of the scene, a fixed position, a circle around the scene, or tracking of an object.
class CameraController
{
public:
    explicit CameraController(ViewChoice choice) : choice_(std::move(choice)) {}

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

class Painter
{
public:
    static Result<Painter> make(const ViewerOptions& options);

    /// The picture, valid until the next call. `camera`: of the scene; empty: the view that the options choose.
    Result<const render::Picture*> paint(const Moment& moment, const std::string& camera = {});

private:
    Painter(const ViewerOptions& options, std::unique_ptr<render::Renderer> renderer);

    SceneModel model_;
    CameraController camera_;
    std::unique_ptr<render::Renderer> renderer_;
    render::Picture picture_;
};

}  // namespace plab::view
