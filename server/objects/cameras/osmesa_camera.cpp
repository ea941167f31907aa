#include "osmesa_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace plab::cameras
{
namespace
{

using render::Form;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Unit kHertz{"Hz", {{0, 0, -1, 0}}};
constexpr Vec3 kNotGiven{kInfinity, kInfinity, kInfinity};

/// The number of the picture that shows `time`. A time that differs from a multiple of the interval only by rounding counts as one.
std::int64_t picture_at(double time, double frames_per_second)
{
    return static_cast<std::int64_t>(std::floor(time * frames_per_second * (1 + 1e-12) + 1e-9));
}

/// A compound is drawn by the triangles of all its parts.
bool is_mesh(const Geometry& geometry) { return geometry.kind == GeometryKind::Mesh || geometry.kind == GeometryKind::Compound; }

void keep_meshes(const RenderScene& render_scene, Studio& studio)
{
    render::Drawing& drawing = studio.drawing;
    if (studio.meshes_known && drawing.meshes_revision == render_scene.shapes_revision) return;
    drawing.meshes.clear(), studio.mesh_of_shape.clear();
    for (const Visual& visual : render_scene.visuals)
    {
        if (!visual.geometry || !is_mesh(*visual.geometry)) continue;
        const auto number = static_cast<std::uint32_t>(drawing.meshes.size());
        if (!studio.mesh_of_shape.try_emplace(visual.shape, number).second) continue;
        drawing.meshes.push_back({visual.geometry->vertices, visual.geometry->triangles});
    }
    drawing.meshes_revision = render_scene.shapes_revision, studio.meshes_known = true;
    studio.overview.reset();
}

Form form_of(const Visual& visual)
{
    if (!visual.geometry) return Form::Cylinder;
    switch (visual.geometry->kind)
    {
        case GeometryKind::Box:
            return Form::Box;
        case GeometryKind::Plane:
            return Form::Plane;
        case GeometryKind::Mesh:
        case GeometryKind::Compound:
            return Form::Mesh;
        case GeometryKind::Cylinder:
            return Form::Cylinder;
        case GeometryKind::Capsule:
            return Form::Capsule;
        case GeometryKind::Sphere:
        case GeometryKind::None:
            break;
    }
    return Form::Sphere;
}

void place_items(const RenderScene& render_scene, Studio& studio)
{
    std::vector<render::Item>& items = studio.drawing.items;
    items.clear();
    for (const Visual& visual : render_scene.visuals)
    {
        if (visual.geometry && visual.geometry->kind == GeometryKind::None) continue;
        render::Item item;
        item.form = form_of(visual);
        item.pose = visual.pose;
        item.color = visual.color;
        item.size = visual.geometry ? visual.geometry->size : visual.size;
        if (item.form == Form::Mesh) item.mesh = studio.mesh_of_shape.at(visual.shape);
        items.push_back(item);
    }
}

Result<render::View> named_view(const std::string& name, const RenderScene& render_scene)
{
    std::string known;
    for (const NamedView& view : render_scene.views)
    {
        if (view.name == name) return render::View{view.position, view.look_at, view.up, view.field_of_view};
        known += (known.empty() ? "" : ", ") + view.name;
    }
    return reason("the scene has no <camera id=\"" + name + "\">; " + (known.empty() ? "it has none" : "it has " + known));
}

Result<render::View> view_of(Row row, const CameraRows& cameras, const RenderScene& render_scene, Studio& studio)
{
    if (!cameras.view[row].empty()) return named_view(cameras.view[row], render_scene);
    if (cameras.position[row] != kNotGiven)
        return render::View{cameras.position[row], cameras.look_at[row], cameras.up[row], cameras.field_of_view[row]};
    // The overview keeps its place until objects are added or removed.
    if (!studio.overview) studio.overview = render::view_of_everything(studio.drawing);
    return *studio.overview;
}

/// One line per interaction; its parts ("contact.response") are on the line of their owner.
std::vector<render::Caption> captions_of(double time, const RenderScene& render_scene)
{
    char text[48];
    std::snprintf(text, sizeof text, "t = %.3f s", time);
    std::vector<render::Caption> out{{text, false}};
    for (const std::string& line : render_scene.algorithms)
    {
        const std::size_t colon = line.find(": "), dot = line.rfind('.', colon);
        const std::string owner = dot < colon ? line.substr(0, dot) + ": " : std::string();
        const auto above =
            std::find_if(out.begin() + 1, out.end(), [&](const render::Caption& c) { return !owner.empty() && c.text.starts_with(owner); });
        if (above != out.end() && colon != std::string::npos)
            above->text += ", " + line.substr(colon + 2);
        else
            out.push_back({line, true});
    }
    return out;
}

/// Keeps a renderer of the size that is requested now; one that could not be created is not tried again.
Result<void> keep_renderer(Row row, const CameraRows& cameras, Studio& studio)
{
    const std::int64_t width = cameras.width[row], height = cameras.height[row];
    if (studio.width == width && studio.height == height) return {};
    studio.renderer.reset();
    studio.width = width, studio.height = height;
    auto made = render::make_renderer(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
    if (!made) return made.error();
    studio.renderer = made.take();
    return {};
}

Result<void> draw_now(const StepContext& context, Row row, CameraRows& cameras, const RenderScene& render_scene, ImageSink& images)
{
    Studio& studio = cameras.studio[row];
    if (auto done = keep_renderer(row, cameras, studio); !done) return done;
    if (!studio.renderer) return {};  // reported before
    keep_meshes(render_scene, studio);
    place_items(render_scene, studio);
    const auto view = view_of(row, cameras, render_scene, studio);
    if (!view) return view.error();
    studio.drawing.view = *view;
    studio.drawing.captions = cameras.captions[row] ? captions_of(context.time, render_scene) : std::vector<render::Caption>{};

    render::Picture picture;
    if (auto done = studio.renderer->draw(studio.drawing, picture); !done) return done;
    studio.complaint.clear();
    images.show(context.component_of_row[row], picture.width, picture.height, std::move(picture.rgba));
    return {};
}

}  // namespace

void CameraRows::describe(Schema& s)
{
    s.param(view, "view", unit::one, "name of a camera of the scene; empty: the place below").or_else("");
    s.param(position, "position", unit::metre,
            "of the camera, in the world; infinite: not given, then a place from which it sees everything")
        .or_else(kNotGiven)
        .may_be_infinite();
    s.param(look_at, "look_at", unit::metre, "the point in the picture's middle, in the world").or_else({});
    s.param(up, "up", unit::one, "the upward direction of the picture, in the world").or_else({0, 0, 1}).unit_length();
    s.param(field_of_view, "field_of_view", unit::radian, "between the picture's lower and upper edge").or_else(0.7).positive().at_most(3);
    s.param(width, "width", unit::one, "pixels").or_else(800).at_least(16).at_most(8192);
    s.param(height, "height", unit::one, "pixels").or_else(600).at_least(16).at_most(8192);
    s.param(frames_per_second, "frames_per_second", kHertz, "pictures per second of simulated time, at most one a step")
        .or_else(25)
        .positive();
    s.param(captions, "captions", unit::one, "the time at the top, the interactions' algorithms at the bottom").or_else(true);
    s.scratch(studio, "studio", "the renderer, and what it keeps from picture to picture");
}

void draw(const StepContext& context, Row row, CameraRows& cameras, const RenderScene& render_scene, ImageSink& images)
{
    Studio& studio = cameras.studio[row];
    const std::int64_t number = picture_at(context.time, cameras.frames_per_second[row]);
    // After a reset the numbers start again from 0, so any change of the number makes a picture due.
    if (number == studio.last_picture || !images.wanted()) return;
    studio.last_picture = number;
    const auto done = draw_now(context, row, cameras, render_scene, images);
    if (done || done.error().reason == studio.complaint) return;
    studio.complaint = done.error().reason;
    context.emit(row, "camera.error", Severity::Warning, "no picture: " + studio.complaint);
}

}  // namespace plab::cameras
