/// An OpenGL context without a screen.
#pragma once

#include <vector>

#include "gl.h"
#include "plab/result.h"

namespace plab::render
{

class OffscreenContext
{
public:
    /// A core profile of OpenGL 3.3 or newer.
    static Result<OffscreenContext> make();

    OffscreenContext(OffscreenContext&& other) noexcept : context_(std::exchange(other.context_, nullptr)) {}
    OffscreenContext& operator=(OffscreenContext&&) = delete;
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;
    ~OffscreenContext();

    /// Makes it current for the calling thread, until `release`. Another thread that used it must have released it.
    Result<void> acquire();
    static void release();

private:
    explicit OffscreenContext(OSMesaContext context) : context_(context) {}

    OSMesaContext context_ = nullptr;
};

}  // namespace plab::render
