# Writes the GLSL files into one C++ file, so that the program needs no files beside it.
# cmake -D OUTPUT=shaders.cpp -D "FILES=a.frag;b.glsl" -P embed.cmake
set(TEXT "// Made by embed.cmake from the files in raster/shaders.\n\n#include \"raster/gl/shader_source.hpp\"\n\n")
string(APPEND TEXT "namespace earthshine::raster {\n\nstd::string_view findShaderText(std::string_view name) {\n")
foreach(FILE IN LISTS FILES)
  get_filename_component(NAME "${FILE}" NAME)
  file(READ "${FILE}" CONTENT)
  string(APPEND TEXT "    if (name == \"${NAME}\") return R\"glsl(${CONTENT})glsl\";\n")
endforeach()
string(APPEND TEXT "    return {};\n}\n\n}  // namespace earthshine::raster\n")
file(WRITE "${OUTPUT}" "${TEXT}")
