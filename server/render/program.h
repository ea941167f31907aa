/// A linked shader program and its uniforms.
#pragma once

#include <string>

#include "gl.h"
#include "matrix.h"
#include "plab/result.h"
#include "shaders.h"

namespace plab::render
{

class Program
{
public:
    Program() = default;
    /// The error contains the compiler's log.
    static Result<Program> make(const ShaderText& text);

    void use() const { glUseProgram(program_.name()); }
    // Each sets a uniform of the program in use; a uniform that the compiler removed is ignored.
    void set(const char* name, const Mat4& m) const { glUniformMatrix4fv(at(name), 1, GL_FALSE, m.m); }
    void set(const char* name, const Vec3& v) const;
    void set(const char* name, double a, double b) const { glUniform2f(at(name), static_cast<float>(a), static_cast<float>(b)); }
    void set(const char* name, double a) const { glUniform1f(at(name), static_cast<float>(a)); }
    void set_unit(const char* name, int texture_unit) const { glUniform1i(at(name), texture_unit); }

private:
    explicit Program(ProgramName program) : program_(std::move(program)) {}
    GLint at(const char* name) const { return glGetUniformLocation(program_.name(), name); }

    ProgramName program_;
};

}  // namespace plab::render
