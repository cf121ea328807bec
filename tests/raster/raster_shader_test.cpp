// Shaders as files: includes, defines, and errors that name the file and its line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "earthshine/error.hpp"
#include "raster/gl/shader_program.hpp"
#include "raster/gl/shader_source.hpp"
#include "raster/raster_support.hpp"

namespace earthshine::raster::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(RasterShader, IncludesAreResolvedOnceAndLinesCountOn) {
    const ShaderSource source = loadShader("gbuffer.frag", {"ALPHA_MASK"});
    EXPECT_THAT(source.files, ElementsAre("gbuffer.frag", "material.glsl", "safe_normalize.glsl"));
    EXPECT_THAT(source.text, StartsWith("#version 330 core\n#define ALPHA_MASK\n#line 2 0\n"));
    EXPECT_THAT(source.text, testing::Not(HasSubstr("#include")));
    // The line after an include has the number that it has in its file.
    const std::string_view file = findShaderText("gbuffer.frag");
    const std::size_t include = file.find("#include \"material.glsl\"");
    ASSERT_NE(include, std::string_view::npos);
    const auto line = std::count(file.begin(), file.begin() + std::ptrdiff_t(include), '\n') + 1;
    EXPECT_THAT(source.text, HasSubstr("#line " + std::to_string(line + 1) + " 0\n"));
}

TEST(RasterShader, ErrorsNameFilesInEveryDriversWords) {
    const std::vector<std::string> files = {"a.frag", "b.glsl"};
    EXPECT_EQ(nameFiles("0:12(3): error: x\n1:7(1): warning: y", files),
              "a.frag:12(3): error: x\nb.glsl:7(1): warning: y");
    EXPECT_EQ(nameFiles("1(12) : error C1008: x", files), "b.glsl:12 : error C1008: x");
    EXPECT_EQ(nameFiles("ERROR: 1:12: 'x' : undeclared", files), "ERROR: b.glsl:12: 'x' : undeclared");
    EXPECT_EQ(nameFiles("9:12: no such file 3", files), "9:12: no such file 3");
}

TEST(RasterShader, BrokenShadersSayWhere) {
    sharedContext().makeCurrent();
    try {
        // A define that makes the text senseless: the mistake is then in scene.vert itself.
        ShaderProgram(sharedContext(), {"scene.vert", "gbuffer.frag", {"positionOs 0.0"}, {}, {}});
        FAIL() << "it compiled";
    } catch (const BuildError& error) {
        EXPECT_THAT(error.what(), StartsWith("raster/shaders/scene.vert: does not compile on \""));
        EXPECT_THAT(error.what(), HasSubstr("scene.vert:"));
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
        EXPECT_THAT(error.log(), HasSubstr("error"));
    }
    EXPECT_THROW(ShaderProgram(sharedContext(), {"scene.vert", "none.frag", {}, {}, {}}), BuildError);
}

TEST(RasterShader, ShadersThatDoNotFitSaySo) {
    sharedContext().makeCurrent();
    try {
        // material.glsl alone is no whole program: it has no main().
        ShaderProgram(sharedContext(), {"scene.vert", "safe_normalize.glsl", {}, {}, {}});
        FAIL() << "it linked";
    } catch (const BuildError& error) {
        EXPECT_THAT(error.what(), StartsWith("raster/shaders/"));
    }
}

}  // namespace
}  // namespace earthshine::raster::test
