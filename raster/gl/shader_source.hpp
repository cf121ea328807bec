#pragma once
// GLSL as it stands in raster/shaders, built into the program.

#include <string>
#include <string_view>
#include <vector>

namespace earthshine::raster {

/// The text of a file of raster/shaders ("gbuffer.frag"); empty if there is none of that name.
std::string_view findShaderText(std::string_view name);

/// One shader with its #include lines replaced by what they name, and the files that it is made of: GLSL's #line names
/// a file by its number, which is its place in `files`.
struct ShaderSource {
    std::string text;
    std::vector<std::string> files;
};

/// Puts the shader `name` together, with `#define D` for each of `defines` after its #version line. An include is a
/// line
/// `#include "file"`; a file is included once. Throws BuildError if a file is not there.
ShaderSource loadShader(std::string_view name, const std::vector<std::string>& defines = {});

/// A compiler's log with "gbuffer.frag:12" in place of its "0:12" or "0(12)".
std::string nameFiles(std::string_view log, const std::vector<std::string>& files);

}  // namespace earthshine::raster
