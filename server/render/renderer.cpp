#include <algorithm>
#include <bit>
#include <utility>

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
/// Texels of the shadow map for each pixel of the picture's longer side, rounded up to a power of two.
constexpr std::uint32_t kLeastShadow = 512, kMostShadow = 4096;
/// Radius of the penumbra, in texels.
constexpr double kSoftness = 2.5;
const Vec3 kGroundColor{0.885, 0.895, 0.905};
/// The ground is translucent: objects below it are visible.
constexpr double kGroundOpacity = 0.6;

struct Programs
{
    Program solid, ball, solid_shadow, ball_shadow, plane, plane_shadow, background;
};

Result<Programs> make_programs()
{
    Programs out;
    const std::pair<Program*, ShaderText> texts[] = {
        {&out.solid, solid_shader()},
        {&out.ball, ball_shader()},
        {&out.plane, plane_shader()},
        {&out.solid_shadow, solid_shadow_shader()},
        {&out.background, background_shader()},
        {&out.ball_shadow, ball_shadow_shader()},
        {&out.plane_shadow, plane_shadow_shader()},
    };
    for (const auto& [program, text] : texts)
    {
        auto made = Program::make(text);
        if (!made) return made.error();
        *program = made.take();
    }
    return out;
}

/// Makes the context current on this thread during its lifetime.
class Current
{
public:
    Current() = default;
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;
    ~Current() { OffscreenContext::release(); }
};

/// Everything that lives in the context; destroyed before it.
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
    OsmesaRenderer(OffscreenContext context, Parts parts, std::uint32_t width, std::uint32_t height)
        : context_(std::move(context)), parts_(std::make_unique<Parts>(std::move(parts))), captions_(height), width_(width), height_(height)
    {
    }
    ~OsmesaRenderer() override
    {
        // OpenGL objects can only be deleted while a context is current; without one they are released with it.
        const bool current = context_.acquire().ok();
        parts_.reset();
        if (current) OffscreenContext::release();
    }
    OsmesaRenderer(const OsmesaRenderer&) = delete;
    OsmesaRenderer& operator=(const OsmesaRenderer&) = delete;

    Result<void> draw(const Drawing& drawing, Picture& out) override;

private:
    void draw_shadow(const Frame& frame) const;
    void draw_solids(const Frame& frame) const;
    void set_light(const Program& program, const Frame& frame) const;
    void draw_planes(const Drawing& drawing, const Frame& frame) const;
    void draw_plane(const Frame& frame, const Pose& pose, const Vec3& color, double opacity) const;
    void draw_plane_shadow(const Frame& frame, const Vec3& origin, const Vec3& normal) const;

    OffscreenContext context_;
    std::unique_ptr<Parts> parts_;
    CaptionPainter captions_;
    std::uint32_t width_, height_;
};

Result<void> OsmesaRenderer::draw(const Drawing& drawing, Picture& out)
{
    if (auto done = context_.acquire(); !done) return done;
    const Current current;
    if (auto done = parts_->batches.keep_meshes(drawing); !done) return done;
    const auto frame = make_frame(drawing, parts_->batches.mesh_radii(), width_, height_);
    if (!frame) return frame.error();
    if (auto done = parts_->batches.sort(drawing, *frame); !done) return done;

    draw_shadow(*frame);
    parts_->target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glClear(GL_DEPTH_BUFFER_BIT);
    draw_solids(*frame);
    glBindVertexArray(parts_->nothing.name());
    parts_->programs.background.use();
    parts_->programs.background.set("picture", width_, height_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    draw_planes(drawing, *frame);

    out.width = width_, out.height = height_;
    parts_->target.read(out.rgba);
    if (glGetError() != GL_NO_ERROR) return reason("OpenGL failed to draw; it may be out of memory");
    captions_.paint(drawing.captions, out);
    return {};
}

void OsmesaRenderer::draw_shadow(const Frame& frame) const
{
    parts_->shadow.bind();
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (!frame.shadows) return;
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(2, 4);  // a surface does not shade itself
    const Programs& programs = parts_->programs;
    programs.solid_shadow.use();
    programs.solid_shadow.set("clip_from_E", frame.light_from_E);
    parts_->batches.draw_solids(true);
    programs.ball_shadow.use();
    programs.ball_shadow.set("clip_from_E", frame.light_from_E);
    programs.ball_shadow.set("light_u", frame.light.right);
    programs.ball_shadow.set("light_v", frame.light.up);
    parts_->batches.draw_ball_shadows();
    glDisable(GL_POLYGON_OFFSET_FILL);
}

void OsmesaRenderer::draw_solids(const Frame& frame) const
{
    const Programs& programs = parts_->programs;
    programs.solid.use();
    programs.solid.set("clip_from_E", frame.clip_from_E);
    set_light(programs.solid, frame);
    parts_->batches.draw_solids(false);

    programs.ball.use();
    programs.ball.set("clip_from_E", frame.clip_from_E);
    programs.ball.set("pixels_per_radian", frame.pixels_per_radian);
    set_light(programs.ball, frame);
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);  // smooth outlines
    parts_->batches.draw_balls();
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void OsmesaRenderer::set_light(const Program& program, const Frame& frame) const
{
    parts_->shadow.use();
    program.set_unit("shadow_map", 0);
    const double texels = parts_->shadow.size();
    program.set("softness", kSoftness / texels);
    program.set("light_from_E", frame.light_from_E);
    program.set("texel", (frame.casters.high.x - frame.casters.low.x) / texels);
    program.set("to_light", frame.to_light);
    program.set("picture", width_, height_);
}

void OsmesaRenderer::draw_planes(const Drawing& drawing, const Frame& frame) const
{
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    bool ground = drawing.ground;
    for (const Item& item : drawing.items)
    {
        if (item.form != Form::Plane || !can_be_drawn(item)) continue;
        const Vec3 normal = rotate(item.pose.q, {0, 0, 1});
        // A plane in the place of the ground replaces it: both together would flicker (z-fighting).
        if (std::fabs(dot(normal, item.pose.p)) < 1e-4 * frame.grid && std::fabs(normal.z) > 1 - 1e-9) ground = false;
        draw_plane(frame, item.pose, item.color, 1);
    }
    glDepthMask(GL_FALSE);
    if (ground) draw_plane(frame, {}, kGroundColor, kGroundOpacity);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void OsmesaRenderer::draw_plane(const Frame& frame, const Pose& pose, const Vec3& color, double opacity) const
{
    const Vec3 u = rotate(pose.q, {1, 0, 0}), v = rotate(pose.q, {0, 1, 0}), n = rotate(pose.q, {0, 0, 1});
    const Vec3 focus = frame.focus - pose.p;
    const Program& program = parts_->programs.plane;
    program.use();
    program.set("clip_from_E", frame.clip_from_E);
    program.set("middle", frame.from_eye(frame.focus - n * dot(n, focus)));
    program.set("side_u", u * frame.plane_range);
    program.set("side_v", v * frame.plane_range);
    program.set("cells", frame.plane_range / frame.grid);
    program.set("phase", std::fmod(dot(u, focus) / frame.grid, 10), std::fmod(dot(v, focus) / frame.grid, 10));
    program.set("color", color);
    program.set("opacity", opacity);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    draw_plane_shadow(frame, pose.p, n);
}

void OsmesaRenderer::draw_plane_shadow(const Frame& frame, const Vec3& origin, const Vec3& normal) const
{
    const double cosine = dot(normal, frame.to_light);
    if (!frame.shadows || cosine < 0.05) return;
    // The volume behind everything that casts a shadow, intersected with the plane: a parallelogram.
    const Vec3 middle = (frame.casters.low + frame.casters.high) * 0.5, half = (frame.casters.high - frame.casters.low) * 0.5;
    const auto along_light = [&](const Vec3& p) { return p - frame.to_light * (dot(p, normal) / cosine); };
    const Vec3 from_origin = frame.light.right * middle.x + frame.light.up * middle.y - frame.from_eye(origin);
    const Program& program = parts_->programs.plane_shadow;
    program.use();
    set_light(program, frame);
    program.set("clip_from_E", frame.clip_from_E);
    program.set("middle", frame.from_eye(origin) + along_light(from_origin));
    program.set("side_u", along_light(frame.light.right) * half.x);
    program.set("side_v", along_light(frame.light.up) * half.y);
    program.set("normal", normal);
    program.set("focus", frame.from_eye(frame.focus));
    program.set("plane_range", frame.plane_range);
    // Drawn slightly in front of the plane itself.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1, -4);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

}  // namespace

Result<std::unique_ptr<Renderer>> make_renderer(std::uint32_t width, std::uint32_t height)
{
    if (width < kLeastSize || width > kMostSize || height < kLeastSize || height > kMostSize)
        return reason("a picture must have from 16 to 8192 pixels in each direction, not " + std::to_string(width) + " x " +
                      std::to_string(height));
    auto context = OffscreenContext::make();
    if (!context) return context.error();
    if (auto done = context->acquire(); !done) return done.error();
    const Current current;
    auto programs = make_programs();
    if (!programs) return programs.error();
    auto target = Target::make(width, height);
    if (!target) return target.error();
    const std::uint32_t texels = std::clamp(std::bit_ceil(std::max(width, height)), kLeastShadow, kMostShadow);
    auto shadow = ShadowMap::make(static_cast<int>(texels));
    if (!shadow) return shadow.error();
    Parts parts{programs.take(), target.take(), shadow.take(), Batches::make(), VertexArray::make()};
    return std::unique_ptr<Renderer>(std::make_unique<OsmesaRenderer>(context.take(), std::move(parts), width, height));
}

}  // namespace plab::render
