// Contexts without a window: each kind that there is draws the same, and a kind that cannot be had says why.

#include <cstdlib>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "earthshine/error.hpp"
#include "earthshine/log.hpp"
#include "raster/raster_support.hpp"

namespace earthshine::raster::test {
namespace {

Scene smallScene() {
    Scene scene;
    scene.materials = {diffuse({0.7f, 0.5f, 0.3f}), diffuse({0.2f, 0.4f, 0.9f})};
    scene.materials[1].baseColorTexture.texture = 0;
    scene.textures = {nearestTexture(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 90, 90, 90, 255, 30, 60, 200, 255})};
    scene.textures[0].isSrgb = true;
    scene.textures[0].linearFilter = true;
    scene.textures[0].mipmaps = true;
    scene.meshes = {unitBox(0, true), unitBox(1)};
    scene.instances = {{0, glm::scale(glm::mat4(1), glm::vec3(3))},
                       {1, glm::rotate(glm::translate(glm::mat4(1), {0.4f, -1, 0}), 0.5f, glm::vec3(0.3f, 1, 0.1f))}};
    return scene;
}

std::vector<Light> smallLights() {
    return {directionalLight({3, 2, 1}, orthographicCamera({1, 2.9, 1}, {0, 0, 0}, 2.5, 8)),
            spotLight({5, 5, 5}, {-1, 2, 1}, {0, -1, 0}, 0.3f, 0.6f, 9)};
}

HostFrame drawIn(GlContext& context) {
    const Extent extent{191, 107};
    SceneRenderer renderer(context, smallScene());
    const Camera camera = lookAtCamera({1.5, 1, 2.5}, {0, -0.5, 0}, extent);
    const Camera previous = lookAtCamera({1.45, 1, 2.5}, {0, -0.5, 0}, extent);
    const RasterSettings settings{extent, 64, 100, glm::vec3(0.5f)};
    const std::vector<Light> lights = smallLights();
    return readFrame(context, renderer.render(camera, previous, lights, settings));
}

void expectSameBits(const HostImage& a, const HostImage& b, const char* what) {
    ASSERT_EQ(a.extent(), b.extent()) << what;
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.sizeBytes()), 0) << what;
}

// Where one rasterizer (Mesa's llvmpipe, or a GPU) stands behind several kinds, not a bit may differ.
TEST(RasterContext, AllKindsDrawTheSame) {
    const auto tested = createContext(testedKind());
    const HostFrame reference = drawIn(*tested);
    EXPECT_GT(rgba(reference.rsmFlux, 32, 32).x, 0.0f);
    EXPECT_GT(rgba(reference.rsmFlux, 32, 64 + 32).x, 0.0f);
    for (const char* which : {"egl", "egl-device", "osmesa"}) {
        SCOPED_TRACE(which);
        const auto context = otherContext(which);
        if (!context) continue;
        if (context->description().renderer != tested->description().renderer) {
            // A GPU under test, and Mesa beside it.
            EXPECT_TRUE(std::getenv("EARTHSHINE_TEST_GL")) << context->description().renderer;
            continue;
        }
        const HostFrame frame = drawIn(*context);
        expectSameBits(frame.albedo, reference.albedo, "albedo");
        expectSameBits(frame.normalWs, reference.normalWs, "normalWs");
        expectSameBits(frame.depth, reference.depth, "depth");
        expectSameBits(frame.motion, reference.motion, "motion");
        expectSameBits(frame.emission, reference.emission, "emission");
        expectSameBits(frame.rsmDepth, reference.rsmDepth, "rsmDepth");
        expectSameBits(frame.rsmNormalWs, reference.rsmNormalWs, "rsmNormalWs");
        expectSameBits(frame.rsmFlux, reference.rsmFlux, "rsmFlux");
        expectSameBits(frame.shadowDepth, reference.shadowDepth, "shadowDepth");
    }
}

// Two GL libraries in one thread, each believing that its context stays current. The viewport tells which one answers.
TEST(RasterContext, ContextsTakeTurns) {
    const auto egl = createContext(testedKind());
    auto second = otherContext("osmesa");
    if (!second) second = createContext(testedKind());
    GlContext* const contexts[] = {egl.get(), second.get()};
    for (int i = 0; i < 2; ++i) {
        contexts[i]->makeCurrent();
        contexts[i]->gl().Viewport(0, 0, 10 + i, 20 + i);
    }
    for (int turn = 0; turn < 6; ++turn) {
        GlContext& context = *contexts[turn % 2];
        context.makeCurrent();
        int viewport[4] = {};
        context.gl().GetIntegerv(GL_VIEWPORT, viewport);
        EXPECT_THAT(viewport, testing::ElementsAre(0, 0, 10 + turn % 2, 20 + turn % 2));
    }
}

TEST(RasterContext, AutoFindsOneAndSaysWhich) {
    std::vector<std::string> lines;
    setLogSink([&](LogLevel, std::string_view line) { lines.emplace_back(line); });
    const auto context = createContext("auto");
    setLogSink({});
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_THAT(lines[0], testing::HasSubstr(context->description().renderer));
    EXPECT_THAT(lines[0], testing::HasSubstr(context->description().platform));
    EXPECT_GE(context->description().maxTextureSizePx, 1024);  // what OpenGL 3.3 promises
}

TEST(RasterContext, UnknownKindIsAUsageError) {
    for (const char* which : {"glx", "", "egl-device:", "egl-device:x", "egl-device:-1"})
        EXPECT_THROW(createContext(which), UsageError) << which;
}

TEST(RasterContext, MissingDeviceSaysWhatIsThere) {
    try {
        createContext("egl-device:97");
        FAIL() << "there is no such device";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("egl-device:97: EGL lists"));
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
    }
}

TEST(RasterContext, GlErrorsBecomeDeviceErrors) {
    GlContext& context = sharedContext();
    context.makeCurrent();
    context.gl().Enable(0xdead);
    try {
        context.check("a test");
        FAIL() << "0xdead is no capability";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("a test: GL_INVALID_ENUM (0x500) on \""));
    }
    EXPECT_NO_THROW(context.check("afterwards"));
}

}  // namespace
}  // namespace earthshine::raster::test
