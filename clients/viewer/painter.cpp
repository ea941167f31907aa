#include "viewer/painter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plab::view
{

Painter::Painter(const ViewerOptions& options, std::unique_ptr<render::Renderer> renderer)
    : model_({options.captions, options.ground}), camera_(options.view), renderer_(std::move(renderer))
{
}

Result<Painter> Painter::make(const ViewerOptions& options)
{
    auto renderer = render::make_renderer(options.width, options.height);
    if (!renderer) return renderer.errors();
    return Painter(options, renderer.take());
}

Result<const render::Picture*> Painter::paint(const Moment& moment, const std::string& camera)
{
    model_.use(moment.scene);
    render::Drawing& drawing = model_.draw(moment.state);
    auto view = camera_.find(model_, drawing.items, moment.state, camera);
    if (!view) return view.errors();
    drawing.view = *view;
    if (auto drawn = renderer_->draw(drawing, picture_); !drawn) return drawn.errors();
    return &picture_;
}

namespace
{

render::View view_of(const link::Camera& camera) { return {camera.position, camera.look_at, camera.up, camera.field_of_view}; }

std::string names_of(const std::vector<link::Camera>& cameras)
{
    std::string out;
    for (const link::Camera& c : cameras) out += (out.empty() ? "" : ", ") + c.name;
    return out;
}

Result<render::View> view_of(const std::vector<link::Camera>& cameras, const std::string& name)
{
    const auto camera = std::find_if(cameras.begin(), cameras.end(), [&](const link::Camera& c) { return c.name == name; });
    if (camera != cameras.end()) return view_of(*camera);
    return reason("the scene has no camera '" + name + "'; " + (cameras.empty() ? "it has none" : "it has: " + names_of(cameras)));
}

}  // namespace

Result<render::View> CameraController::start(const SceneModel& model, const std::string& camera) const
{
    if (!camera.empty()) return view_of(model.cameras(), camera);
    if (!choice_.camera.empty()) return view_of(model.cameras(), choice_.camera);
    if (choice_.from || choice_.orbit || model.cameras().empty()) return *of_everything_;
    if (auto front = view_of(model.cameras(), "front")) return front;
    return view_of(model.cameras().front());
}

void CameraController::circle(render::View& view, double time) const
{
    // As far away and as high as the view of everything; a given radius changes only the distance.
    const Vec3 arm = of_everything_->position - of_everything_->look_at;
    const double distance = length(arm);
    const double elevation = distance > 0 ? std::asin(std::clamp(arm.z / distance, -1.0, 1.0)) : 0.35;
    const double radius = *choice_.orbit > 0 ? *choice_.orbit : distance;
    const double angle = std::atan2(arm.y, arm.x) + 2 * std::numbers::pi * time / choice_.orbit_period;
    const Vec3 direction{std::cos(elevation) * std::cos(angle), std::cos(elevation) * std::sin(angle), std::sin(elevation)};
    view.position = view.look_at + radius * direction;
}

Result<render::View> CameraController::find(const SceneModel& model, const std::vector<render::Item>& items, const State& state,
                                            const std::string& camera)
{
    if (!of_everything_ || run_ != state.run) of_everything_ = render::view_of_everything(items);
    run_ = state.run;
    if (!choice_.track.empty())
    {
        if (!model.has_object(choice_.track) && !tracked_) return reason("the scene has no object '" + choice_.track + "' to track");
        // If it has been removed, its last position is used.
        if (const auto place = model.position_of(choice_.track, state)) tracked_ = place;
    }
    auto view = start(model, camera);
    if (!view) return view;
    if (!camera.empty()) return view;
    if (choice_.look_at) view->look_at = *choice_.look_at;
    if (tracked_) view->look_at = *tracked_;
    if (choice_.orbit) circle(*view, state.time);
    if (choice_.from) view->position = *choice_.from;
    if (choice_.up) view->up = *choice_.up;
    return view;
}

}  // namespace plab::view
