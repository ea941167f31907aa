/// Camera/OSMesa: draws off-screen what is visible at the end of a step.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "plab/registrar.h"
#include "render/render.h"

namespace plab::cameras
{

/// What a camera keeps from picture to picture. It is not state, and is rebuilt if it is lost.
struct Studio
{
    std::unique_ptr<render::Renderer> renderer;
    std::int64_t width = 0, height = 0;  ///< of the renderer, or of the one that could not be created
    render::Drawing drawing;
    std::map<std::uint32_t, std::uint32_t> mesh_of_shape;
    bool meshes_known = false;
    std::optional<render::View> overview;
    std::int64_t last_picture = -1;  ///< number of the last picture drawn
    std::string complaint;           ///< the last error, so that it is not reported again
};

struct CameraRows
{
    Column<std::string> view;
    Column<Vec3> position, look_at, up;  ///< W, m; an infinite position: not given
    Column<double> field_of_view;        ///< rad, vertical
    Column<std::int64_t> width, height;  ///< pixels
    Column<double> frames_per_second;    ///< of simulated time, Hz
    Column<bool> captions;
    Column<Studio> studio;

    void describe(Schema& schema);
};

/// Draws if a picture is due and some client wants it.
void draw(const StepContext& context, Row row, CameraRows& cameras, const RenderScene& render_scene, ImageSink& images);

}  // namespace plab::cameras
