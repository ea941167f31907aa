#include "program.h"

namespace plab::render
{
namespace
{

/// Deletes the shader's name in its destructor; the program keeps what it needs.
class Shader
{
public:
    explicit Shader(GLenum stage) : name_(glCreateShader(stage)) {}
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    ~Shader() { glDeleteShader(name_); }
    GLuint name() const { return name_; }

    Result<void> compile(const std::string& source) const
    {
        const GLchar* text = source.c_str();
        glShaderSource(name_, 1, &text, nullptr);
        glCompileShader(name_);
        GLint fine = GL_FALSE, length = 0;
        glGetShaderiv(name_, GL_COMPILE_STATUS, &fine);
        if (fine) return {};
        glGetShaderiv(name_, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), '\0');
        glGetShaderInfoLog(name_, length, nullptr, log.data());
        return reason(log.c_str());
    }

private:
    GLuint name_;
};

}  // namespace

Result<Program> Program::make(const ShaderText& text)
{
    const Shader vertex_shader(GL_VERTEX_SHADER), fragment_shader(GL_FRAGMENT_SHADER);
    if (auto done = vertex_shader.compile(text.vertex); !done)
        return reason("vertex shader of '" + text.name + "' does not compile: " + done.error().reason);
    if (auto done = fragment_shader.compile(text.fragment); !done)
        return reason("fragment shader of '" + text.name + "' does not compile: " + done.error().reason);

    ProgramName program = ProgramName::make();
    glAttachShader(program.name(), vertex_shader.name());
    glAttachShader(program.name(), fragment_shader.name());
    glLinkProgram(program.name());
    GLint fine = GL_FALSE, length = 0;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &fine);
    if (fine) return Program(std::move(program));
    glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetProgramInfoLog(program.name(), length, nullptr, log.data());
    return reason("shader program '" + text.name + "' does not link: " + log.c_str());
}

void Program::set(const char* name, const Vec3& v) const
{
    glUniform3f(at(name), static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

}  // namespace plab::render
