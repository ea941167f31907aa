/// OpenGL for this folder: OSMesa links its functions, so that no loader is needed.
#pragma once

#define GL_GLEXT_PROTOTYPES 1
#include <GL/osmesa.h>

#include <utility>

namespace plab::render
{

/// Owns one OpenGL object name. The context must be current when it is created and destroyed.
template <class Kind>
class Handle
{
public:
    Handle() = default;
    static Handle make()
    {
        Handle out;
        Kind::make(out.name_);
        return out;
    }
    Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept
    {
        std::swap(name_, other.name_);
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle()
    {
        if (name_ != 0) Kind::destroy(name_);
    }
    GLuint name() const { return name_; }

private:
    GLuint name_ = 0;
};

namespace kind
{
struct Buffer
{
    static void make(GLuint& n) { glGenBuffers(1, &n); }
    static void destroy(GLuint n) { glDeleteBuffers(1, &n); }
};
struct VertexArray
{
    static void make(GLuint& n) { glGenVertexArrays(1, &n); }
    static void destroy(GLuint n) { glDeleteVertexArrays(1, &n); }
};
struct Texture
{
    static void make(GLuint& n) { glGenTextures(1, &n); }
    static void destroy(GLuint n) { glDeleteTextures(1, &n); }
};
struct Renderbuffer
{
    static void make(GLuint& n) { glGenRenderbuffers(1, &n); }
    static void destroy(GLuint n) { glDeleteRenderbuffers(1, &n); }
};
struct Framebuffer
{
    static void make(GLuint& n) { glGenFramebuffers(1, &n); }
    static void destroy(GLuint n) { glDeleteFramebuffers(1, &n); }
};
struct Program
{
    static void make(GLuint& n) { n = glCreateProgram(); }
    static void destroy(GLuint n) { glDeleteProgram(n); }
};
}  // namespace kind

using Buffer = Handle<kind::Buffer>;
using VertexArray = Handle<kind::VertexArray>;
using Texture = Handle<kind::Texture>;
using Renderbuffer = Handle<kind::Renderbuffer>;
using Framebuffer = Handle<kind::Framebuffer>;
using ProgramName = Handle<kind::Program>;

}  // namespace plab::render
