/// An OpenGL context without a screen.
#pragma once

#include <vector>

#include "gl.h"
#include "plab/result.h"

namespace plab::render
{

class Context
{
public:
    /// A core profile of OpenGL 3.3 or newer.
    static Result<Context> make();

    Context(Context&& other) noexcept : context_(std::exchange(other.context_, nullptr)) {}
    Context& operator=(Context&&) = delete;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    ~Context();

    /// Makes it current for the calling thread, until `release`. Another thread that used it must have released it.
    Result<void> acquire();
    static void release();

private:
    explicit Context(OSMesaContext context) : context_(context) {}

    OSMesaContext context_ = nullptr;
};

}  // namespace plab::render
