#include "target.h"

#include <algorithm>
#include <string>

namespace plab::render
{
namespace
{

/// Larger pictures are drawn without extra samples, which would take more than a gigabyte.
constexpr std::uint64_t kMostSampledPixels = 20'000'000;

Renderbuffer make_storage(GLenum format, int samples, std::uint32_t width, std::uint32_t height)
{
    Renderbuffer out = Renderbuffer::make();
    glBindRenderbuffer(GL_RENDERBUFFER, out.name());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    return out;
}

Result<void> check_frame(const std::string& what)
{
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE && glGetError() == GL_NO_ERROR) return {};
    return reason("OpenGL cannot allocate memory for " + what + "; try a smaller size");
}

}  // namespace

Result<Target> Target::make(std::uint32_t width, std::uint32_t height)
{
    GLint most = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    const bool sampled = std::uint64_t{width} * height <= kMostSampledPixels;
    const int samples = sampled ? std::min(most, 4) : 0;

    Target out;
    out.width_ = width, out.height_ = height;
    out.samples_ = Framebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, out.samples_.name());
    // Without alpha: the picture is opaque, whatever was blended into it.
    out.color_ = make_storage(GL_RGB8, samples, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, out.color_.name());
    out.depth_ = make_storage(GL_DEPTH_COMPONENT24, samples, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, out.depth_.name());
    if (auto done = check_frame("the picture"); !done) return done.error();

    out.resolved_ = Framebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, out.resolved_.name());
    out.resolved_color_ = make_storage(GL_RGB8, 0, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, out.resolved_color_.name());
    if (auto done = check_frame("the picture"); !done) return done.error();
    return out;
}

void Target::bind() const
{
    glBindFramebuffer(GL_FRAMEBUFFER, samples_.name());
    glViewport(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_));
}

void Target::read(std::vector<std::uint8_t>& rgba) const
{
    const GLint width = static_cast<GLint>(width_), height = static_cast<GLint>(height_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
    const std::size_t row = std::size_t{4} * width_;
    rgba.resize(row * height_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    // OpenGL counts rows from the bottom.
    for (std::size_t top = 0, bottom = height_ - 1; top < bottom; ++top, --bottom)
        std::swap_ranges(rgba.begin() + static_cast<std::ptrdiff_t>(top * row), rgba.begin() + static_cast<std::ptrdiff_t>((top + 1) * row),
                         rgba.begin() + static_cast<std::ptrdiff_t>(bottom * row));
}

Result<ShadowMap> ShadowMap::make(int size)
{
    ShadowMap out;
    out.size_ = size;
    out.depth_ = Texture::make();
    out.use();
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    // Everything outside of the map is lit.
    constexpr float far[] = {1, 1, 1, 1};
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, far);

    out.frame_ = Framebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, out.frame_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, out.depth_.name(), 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    if (auto done = check_frame("the shadows"); !done) return done.error();
    return out;
}

void ShadowMap::bind() const
{
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.name());
    glViewport(0, 0, size_, size_);
}

void ShadowMap::use() const
{
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, depth_.name());
}

}  // namespace plab::render
