// The layer of the gl-sharing tests (gl_sharing_layer.cpp): each rule of the extension, broken on purpose, is noticed.

#include <gmock/gmock.h>

#include <GL/glcorearb.h>

#include <limits>
#include <memory>

#include "interop/gl_sharing_fixture.hpp"
#include "interop/gl_sharing_transport.hpp"
#include "support/surface_pixels.hpp"

namespace earthshine {
namespace {

using test::deviceErrorOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The layer itself: broken on purpose, each rule is noticed.
class GlSharingRules : public GlSharing {
protected:
    GlSharingRules()
        : opened(openWithGlSharing(Device(device()), {}, context->handle())),
          shared(std::make_unique<GlSharingTransport>(opened, context->handle())) {
        const raster::GlFunctions& gl = context->gl();
        gl.GenTextures(1, &texture.name);
        gl.BindTexture(GL_TEXTURE_2D, texture.name);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
        upload(1.0f);
        both = shared->image(texture);
        image = both.image;
    }
    void upload(float value) const {
        const std::vector<float> pixels(4 * 4 * 4, value);
        context->gl().BindTexture(GL_TEXTURE_2D, texture.name);
        context->gl().TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 4, 4, 0, GL_RGBA, GL_FLOAT, pixels.data());
    }
    float read() const {
        std::vector<float> pixels(4 * 4 * 4);
        opened.impl().queue.enqueueReadImage(image, CL_TRUE, {0, 0, 0}, {4, 4, 1}, 0, 0, pixels.data());
        return pixels[5];
    }
    void expectViolation(const std::string& words) const {
        const auto lines = violationsOf(layerLines());
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_THAT(lines[0], HasSubstr(words));
    }

    Device opened;
    std::unique_ptr<GlSharingTransport> shared;
    GlTexture texture{0, PixelFormat::RGBA32F, {4, 4}};
    SharedImage both;
    cl::Image2D image;  ///< of both
    TransportCost cost;
};

TEST_F(GlSharingRules, KeptTheyGiveThePixels) {
    shared->acquire({both}, cost);
    EXPECT_EQ(read(), 1.0f);
    shared->release({both}, cost);
    upload(2.0f);
    shared->acquire({both}, cost);
    EXPECT_EQ(read(), 2.0f);
    shared->release({both}, cost);
    EXPECT_THAT(violationsOf(layerLines()), IsEmpty());
}
TEST_F(GlSharingRules, WhatIsNotFiniteStopsAtTheDoor) {
    // The rule of unpack.cl holds for shared textures, too.
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::vector<float> pixels(4 * 4 * 4, 0.25f);
    pixels[0] = std::numeric_limits<float>::quiet_NaN();
    pixels[1] = kInfinity;
    pixels[2] = -kInfinity;
    pixels[4] = 1e20f;
    pixels[5] = -1e20f;
    pixels[6] = -1e15f;
    context->gl().BindTexture(GL_TEXTURE_2D, texture.name);
    context->gl().TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 4, 4, 0, GL_RGBA, GL_FLOAT, pixels.data());
    for (const char* storage : {"image", "planar", "packed"}) {
        DeviceOptions options;
        options.storage = storage;
        const Device sharing = openWithGlSharing(Device(device()), options, context->handle());
        GlSharingTransport transport(sharing, context->handle());
        const SharedImage image3 = transport.image(texture);
        ImportImageStage import(sharing);
        const Surface surface(sharing, PixelFormat::RGBA32F, {4, 4});
        transport.acquire({image3}, cost);
        import.enqueue(image3.image, surface);
        transport.release({image3}, cost);
        const HostImage arrived = test::readSurface(sharing, surface);
        const float* p = arrived.pixel(0, 0);
        EXPECT_THAT(std::vector<float>(p, p + 4), ElementsAre(0, 0, 0, 1)) << storage;
        const float rounding = 1e15f * (storage == std::string("packed") ? 0x1p-13f : 0.0f);
        EXPECT_NEAR(p[4], 1e15f, rounding) << storage;
        EXPECT_NEAR(p[5], -1e15f, rounding) << storage;
        EXPECT_NEAR(p[6], -1e15f, rounding) << storage;
        EXPECT_EQ(p[8], 0.25f);
    }
    EXPECT_THAT(violationsOf(layerLines()), IsEmpty());
}
TEST_F(GlSharingRules, UseBeforeAcquire) {
    EXPECT_THROW(read(), cl::Error);
    expectViolation("reading of texture");
}
TEST_F(GlSharingRules, KernelAfterRelease) {
    shared->acquire({both}, cost);
    ImportImageStage import(opened);
    const Surface surface(opened, PixelFormat::RGBA32F, {4, 4});
    import.enqueue(image, surface);
    shared->release({both}, cost);
    EXPECT_THAT(deviceErrorOf([&] { import.enqueue(image, surface); }), HasSubstr("import_image: launching"));
    expectViolation("a kernel's use of texture");
}
TEST_F(GlSharingRules, DrawingWhileAcquired) {
    shared->acquire({both}, cost);
    upload(2.0f);
    deviceErrorOf([&] { shared->release({both}, cost); });
    expectViolation("GL touched texture");
}
TEST_F(GlSharingRules, AcquireTwice) {
    shared->acquire({both}, cost);
    deviceErrorOf([&] { shared->acquire({both}, cost); });
    expectViolation("which is acquired already");
}
TEST_F(GlSharingRules, ReleaseTwice) {
    shared->acquire({both}, cost);
    shared->release({both}, cost);
    deviceErrorOf([&] { shared->release({both}, cost); });
    expectViolation("which is not acquired");
}
TEST_F(GlSharingRules, AnotherGlContext) {
    const auto other = raster::createContext(raster::test::testedKind());
    deviceErrorOf([&] { shared->acquire({both}, cost); });
    context->makeCurrent();
    expectViolation("acquire without its GL context");
}
TEST_F(GlSharingRules, LettingGoWhileAcquired) {
    shared->acquire({both}, cost);
    shared->forget(texture.name);
    image = {};
    both = {};
    expectViolation("is let go while it is acquired");
}
TEST_F(GlSharingRules, DeletingATextureBeforeItsImage) {
    context->gl().DeleteTextures(1, &texture.name);
    shared->forget(texture.name);
    image = {};
    both = {};
    expectViolation("was deleted before its image");
}
TEST_F(GlSharingRules, AnotherQueue) {
    const Device other = openWithGlSharing(Device(device()), {}, context->handle());
    const std::vector<cl::Memory> objects{image};
    EXPECT_THROW(other.impl().queue.enqueueAcquireGLObjects(&objects), cl::Error);
    expectViolation("in a queue of another context");
}

}  // namespace
}  // namespace earthshine
