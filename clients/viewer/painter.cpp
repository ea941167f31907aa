#include "viewer/painter.h"

namespace plab::view
{

Painter::Painter(const ViewerOptions& options, std::unique_ptr<render::Renderer> renderer)
    : model_({options.captions, options.ground}), viewpoint_(options.view), renderer_(std::move(renderer))
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
    auto view = viewpoint_.find(model_, drawing.items, moment.state, camera);
    if (!view) return view.errors();
    drawing.view = *view;
    if (auto drawn = renderer_->draw(drawing, picture_); !drawn) return drawn.errors();
    return &picture_;
}

}  // namespace plab::view
