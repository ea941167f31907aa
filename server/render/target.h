/// The render targets: the picture with several samples per pixel, and the shadow map.
#pragma once

#include <cstdint>
#include <vector>

#include "gl.h"
#include "plab/result.h"

namespace plab::render
{

/// Smooth edges: each pixel has four samples of coverage and depth, shaded once per pixel and surface.
class Target
{
public:
    static Result<Target> make(std::uint32_t width, std::uint32_t height);
    void bind() const;
    /// Averages the samples and copies the picture to memory, rows from the top.
    void read(std::vector<std::uint8_t>& rgba) const;

private:
    Target() = default;

    std::uint32_t width_ = 0, height_ = 0;
    Renderbuffer color_, depth_, resolved_color_;
    Framebuffer samples_, resolved_;
};

class ShadowMap
{
public:
    static Result<ShadowMap> make(int size);
    int size() const { return size_; }
    void bind() const;
    /// For sampling, on texture unit 0.
    void use() const;

private:
    ShadowMap() = default;

    int size_ = 0;
    Texture depth_;
    Framebuffer frame_;
};

}  // namespace plab::render
