#include <array>

#include "batches.h"
#include "captions.h"
#include "context.h"
#include "program.h"
#include "render/render.h"
#include "shaders.h"
#include "target.h"

namespace plab::render
{
namespace
{

constexpr std::uint32_t kLeastSize = 16, kMostSize = 8192;
constexpr int kShadowSize = 2048;
const Vec3 kGroundColor{0.86, 0.875, 0.89};
/// The ground is thin: what lies below it can be seen.
constexpr double kGroundOpacity = 0.6;

struct Programs
{
    Program solid, shadow, plane, background;
};

Result<Programs> make_programs()
{
    Programs out;
    const auto build = [](Program& program, const char* name, const std::string& vertex, const std::string& fragment) -> Result<void>
    {
        auto made = Program::make(name, vertex, fragment);
        if (!made) return made.error();
        program = made.take();
        return {};
    };
    if (auto done = build(out.solid, "solid", solid_vertex_shader(), solid_fragment_shader()); !done) return done.error();
    if (auto done = build(out.shadow, "shadow", solid_vertex_shader(), shadow_fragment_shader()); !done) return done.error();
    if (auto done = build(out.plane, "plane", plane_vertex_shader(), plane_fragment_shader()); !done) return done.error();
    if (auto done = build(out.background, "background", background_vertex_shader(), background_fragment_shader()); !done)
        return done.error();
    return out;
}

/// The context of this thread while it lives.
class Current
{
public:
    Current() = default;
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;
    ~Current() { Context::release(); }
};

/// All that lives in the context; gone before it.
struct Parts
{
    Programs programs;
    Target target;
    ShadowMap shadow;
    Batches batches;
    VertexArray nothing;  ///< shaders that make their own vertices need one bound
};

class OsmesaRenderer final : public Renderer
{
public:
    OsmesaRenderer(Context context, Parts parts, std::uint32_t width, std::uint32_t height)
        : context_(std::move(context)), parts_(std::make_unique<Parts>(std::move(parts))), captions_(height), width_(width), height_(height)
    {
    }
    ~OsmesaRenderer() override
    {
        // Names can only be given back to a context; without one they go with it.
        const bool current = context_.acquire().ok();
        parts_.reset();
        if (current) Context::release();
    }
    OsmesaRenderer(const OsmesaRenderer&) = delete;
    OsmesaRenderer& operator=(const OsmesaRenderer&) = delete;

    Result<void> draw(const Drawing& drawing, Picture& out) override;

private:
    void draw_shadow(const Frame& frame) const;
    void set_light(const Program& program, const Frame& frame) const;
    void draw_planes(const Drawing& drawing, const Frame& frame) const;
    void draw_plane(const Frame& frame, const Pose& pose, const Vec3& color, double opacity) const;

    Context context_;
    std::unique_ptr<Parts> parts_;
    CaptionPainter captions_;
    std::uint32_t width_, height_;
};

Result<void> OsmesaRenderer::draw(const Drawing& drawing, Picture& out)
{
    if (auto done = context_.acquire(); !done) return done;
    const Current current;
    if (auto done = parts_->batches.keep_meshes(drawing); !done) return done;
    const auto frame = make_frame(drawing, parts_->batches.mesh_radii(), width_, height_, kShadowSize);
    if (!frame) return frame.error();
    if (auto done = parts_->batches.sort(drawing, *frame); !done) return done;

    draw_shadow(*frame);
    parts_->target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glClear(GL_DEPTH_BUFFER_BIT);
    parts_->programs.solid.use();
    parts_->programs.solid.set("clip_from_E", frame->clip_from_E);
    set_light(parts_->programs.solid, *frame);
    parts_->batches.draw();
    draw_planes(drawing, *frame);

    parts_->programs.background.use();
    parts_->programs.background.set("picture", width_, height_);
    glDrawArrays(GL_TRIANGLES, 0, 3);

    out.width = width_, out.height = height_;
    parts_->target.read(out.rgba);
    if (glGetError() != GL_NO_ERROR) return reason("OpenGL failed to draw; it may be out of memory");
    captions_.paint(drawing.captions, out);
    return {};
}

void OsmesaRenderer::draw_shadow(const Frame& frame) const
{
    if (frame.texel == 0) return;
    parts_->shadow.bind();
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(2, 4);  // a surface does not shade itself
    parts_->programs.shadow.use();
    parts_->programs.shadow.set("clip_from_E", frame.light_from_E);
    parts_->batches.draw();
    glDisable(GL_POLYGON_OFFSET_FILL);
}

void OsmesaRenderer::set_light(const Program& program, const Frame& frame) const
{
    parts_->shadow.use();
    program.set_unit("shadow_map", 0);
    program.set("shadow_step", 1.0 / kShadowSize, 1.0 / kShadowSize);
    program.set("light_from_E", frame.light_from_E);
    program.set("texel", frame.texel);
    program.set("to_light", frame.to_light);
    program.set("picture", width_, height_);
}

void OsmesaRenderer::draw_planes(const Drawing& drawing, const Frame& frame) const
{
    glBindVertexArray(parts_->nothing.name());
    bool ground = drawing.ground;
    for (const Item& item : drawing.items)
    {
        if (item.form != Form::Plane || !can_be_drawn(item)) continue;
        const Vec3 normal = rotate(item.pose.q, {0, 0, 1});
        // A plane where the ground would be takes its place: the two would flicker through one another.
        if (std::fabs(dot(normal, item.pose.p)) < 1e-4 * frame.grid && std::fabs(normal.z) > 1 - 1e-9) ground = false;
        draw_plane(frame, item.pose, item.color, 1);
    }
    if (ground) draw_plane(frame, {}, kGroundColor, kGroundOpacity);
}

void OsmesaRenderer::draw_plane(const Frame& frame, const Pose& pose, const Vec3& color, double opacity) const
{
    const Vec3 u = rotate(pose.q, {1, 0, 0}), v = rotate(pose.q, {0, 1, 0}), n = rotate(pose.q, {0, 0, 1});
    const Vec3 focus = frame.focus - pose.p;
    const Vec3 middle = frame.focus - n * dot(n, focus);
    const Program& program = parts_->programs.plane;
    program.use();
    set_light(program, frame);
    program.set("clip_from_E", frame.clip_from_E);
    program.set("middle", frame.from_eye(middle));
    program.set("axis_u", u);
    program.set("axis_v", v);
    program.set("reach", frame.reach);
    program.set("grid", frame.grid);
    program.set("phase", std::fmod(dot(u, focus) / frame.grid, 10), std::fmod(dot(v, focus) / frame.grid, 10));
    program.set("color", color);
    program.set("opacity", opacity);
    program.set("normal", n);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace

Result<std::unique_ptr<Renderer>> make_renderer(std::uint32_t width, std::uint32_t height)
{
    if (width < kLeastSize || width > kMostSize || height < kLeastSize || height > kMostSize)
        return reason("a picture must have from 16 to 8192 pixels each way, not " + std::to_string(width) + " x " + std::to_string(height));
    auto context = Context::make();
    if (!context) return context.error();
    if (auto done = context->acquire(); !done) return done.error();
    const Current current;
    auto programs = make_programs();
    if (!programs) return programs.error();
    auto target = Target::make(width, height);
    if (!target) return target.error();
    auto shadow = ShadowMap::make(kShadowSize);
    if (!shadow) return shadow.error();
    Parts parts{programs.take(), target.take(), shadow.take(), Batches::make(), VertexArray::make()};
    return std::unique_ptr<Renderer>(std::make_unique<OsmesaRenderer>(context.take(), std::move(parts), width, height));
}

}  // namespace plab::render
