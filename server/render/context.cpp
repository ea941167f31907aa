#include "context.h"

#include <array>

namespace plab::render
{
namespace
{

/// OSMesa requires an image of its own; drawing goes to framebuffer objects, and this image is never read.
constexpr GLsizei kDummySize = 16;

}  // namespace

Result<OffscreenContext> OffscreenContext::make()
{
    constexpr int wanted[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    const OSMesaContext made = OSMesaCreateContextAttribs(wanted, nullptr);
    if (!made) return reason("OSMesa cannot create an OpenGL 3.3 context; Mesa 17 or newer with llvmpipe or softpipe is needed");
    return OffscreenContext(made);
}

OffscreenContext::~OffscreenContext()
{
    if (context_) OSMesaDestroyContext(context_);
}

Result<void> OffscreenContext::acquire()
{
    // Shared by all contexts of a thread; it is never read.
    thread_local std::array<std::uint8_t, 4 * kDummySize * kDummySize> dummy;
    if (!OSMesaMakeCurrent(context_, dummy.data(), GL_UNSIGNED_BYTE, kDummySize, kDummySize))
        return reason("OSMesa cannot make its context current");
    return {};
}

void OffscreenContext::release() { OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

}  // namespace plab::render
