#include "raster/gl/shader_program.hpp"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "earthshine/error.hpp"
#include "raster/gl/shader_source.hpp"

namespace earthshine::raster {

namespace {

[[noreturn]] void throwBuildError(const GlContext& context, const std::string& what, const std::string& log) {
    const std::string firstLine = log.substr(0, log.find('\n'));
    throw BuildError(fmt::format("{} on \"{}\": {}", what, context.description().renderer,
                                 firstLine.empty() ? "the driver gives no reason" : firstLine),
                     log);
}

ShaderObject compile(const GlContext& context, GLenum stage, const std::string& file,
                     const std::vector<std::string>& defines) {
    const GlFunctions& gl = context.gl();
    const ShaderSource source = loadShader(file, defines);
    ShaderObject shader(gl, gl.CreateShader(stage));
    const char* text = source.text.c_str();
    gl.ShaderSource(shader.name(), 1, &text, nullptr);
    gl.CompileShader(shader.name());
    GLint done = GL_FALSE;
    gl.GetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
    if (done) return shader;
    GLint length = 0;
    gl.GetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(length), '\0');
    gl.GetShaderInfoLog(shader.name(), length, &length, log.data());
    log.resize(std::size_t(length));
    throwBuildError(context, fmt::format("raster/shaders/{}: does not compile", file), nameFiles(log, source.files));
}

}  // namespace

ShaderProgram::ShaderProgram(GlContext& context, const Names& names)
    : gl_(&context.gl()), program_(context.gl(), context.gl().CreateProgram()) {
    const GlFunctions& gl = *gl_;
    const GLuint program = program_.name();
    const ShaderObject vertex = compile(context, GL_VERTEX_SHADER, names.vertex, names.defines);
    const ShaderObject fragment = compile(context, GL_FRAGMENT_SHADER, names.fragment, names.defines);
    gl.AttachShader(program, vertex.name());
    gl.AttachShader(program, fragment.name());
    gl.LinkProgram(program);
    GLint done = GL_FALSE;
    gl.GetProgramiv(program, GL_LINK_STATUS, &done);
    if (!done) {
        GLint length = 0;
        gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
        std::string log(std::size_t(length), '\0');
        gl.GetProgramInfoLog(program, length, &length, log.data());
        log.resize(std::size_t(length));
        throwBuildError(context, fmt::format("raster/shaders/{} and {}: do not link", names.vertex, names.fragment),
                        log);
    }
    use();
    for (std::size_t i = 0; i < names.blocks.size(); ++i) {
        const GLuint block = gl.GetUniformBlockIndex(program, names.blocks[i]);
        if (block != GL_INVALID_INDEX) gl.UniformBlockBinding(program, block, GLuint(i));
    }
    for (std::size_t i = 0; i < names.samplers.size(); ++i) gl.Uniform1i(location(names.samplers[i]), GLint(i));
    context.check(fmt::format("raster/shaders/{}", names.fragment));
}

void ShaderProgram::set(const char* name, float value) const {
    gl_->Uniform1f(location(name), value);
}
void ShaderProgram::set(const char* name, const glm::vec2& value) const {
    gl_->Uniform2f(location(name), value.x, value.y);
}
void ShaderProgram::set(const char* name, const glm::vec3& value) const {
    gl_->Uniform3fv(location(name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::mat4& value) const {
    gl_->UniformMatrix4fv(location(name), 1, GL_FALSE, glm::value_ptr(value));
}

}  // namespace earthshine::raster
