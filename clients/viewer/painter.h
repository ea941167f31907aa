/// Converts a moment to a picture: scene, view, renderer.
#pragma once

#include "viewer/moment_buffer.h"
#include "viewer/options.h"
#include "viewer/viewpoint.h"

namespace plab::view
{

class Painter
{
public:
    static Result<Painter> make(const ViewerOptions& options);

    /// The picture, valid until the next call. `camera`: of the scene; empty: the view that the options choose.
    Result<const render::Picture*> paint(const Moment& moment, const std::string& camera = {});

private:
    Painter(const ViewerOptions& options, std::unique_ptr<render::Renderer> renderer);

    SceneModel model_;
    Viewpoint viewpoint_;
    std::unique_ptr<render::Renderer> renderer_;
    render::Picture picture_;
};

}  // namespace plab::view
