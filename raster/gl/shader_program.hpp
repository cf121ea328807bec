#pragma once
// A linked GLSL program of a vertex and a fragment shader.

#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "raster/gl/gl_objects.hpp"

namespace earthshine::raster {

/// Built at construction from files of raster/shaders. Uniforms are set by name; a name that the program does not use
/// (or that the compiler removed) is ignored, as in GL.
class ShaderProgram {
public:
    struct Names {
        std::string vertex;                     ///< file in raster/shaders
        std::string fragment;                   ///< file in raster/shaders
        std::vector<std::string> defines;       ///< "ALPHA_MASK", "SIZE 3"
        std::span<const char* const> blocks;    ///< the uniform block blocks[i] has the binding i
        std::span<const char* const> samplers;  ///< the sampler samplers[i] reads the texture unit i
    };

    /// Throws BuildError with the file, the first line of the compiler's log, and the log.
    ShaderProgram(GlContext& context, const Names& names);

    void use() const { gl_->UseProgram(program_.name()); }

    // Of the program in use.
    void set(const char* name, float value) const;
    void set(const char* name, const glm::vec2& value) const;
    void set(const char* name, const glm::vec3& value) const;
    void set(const char* name, const glm::mat4& value) const;

private:
    int location(const char* name) const { return gl_->GetUniformLocation(program_.name(), name); }

    const GlFunctions* gl_;
    ProgramObject program_;
};

}  // namespace earthshine::raster
