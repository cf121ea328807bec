// Transport `gl-sharing` over a layer that gives the devices here the extension and keeps its rules
// (gl_sharing_layer.cpp): the frame is that of `host`, bit for bit, and no rule is broken.

#include <gmock/gmock.h>

#include <GL/glcorearb.h>

#include <cstdlib>
#include <memory>
#include <optional>

#include "cli/process.hpp"
#include "interop/gl_sharing_fixture.hpp"
#include "interop/gl_sharing_transport.hpp"
#include "support/surface_pixels.hpp"

namespace earthshine {
namespace {

using test::BoxRun;
using test::deviceErrorOf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr Extent kSmall{61, 35}, kLarge{96, 40};

class GlSharingFrames : public GlSharing, public ::testing::WithParamInterface<reference::Variant> {};

TEST_P(GlSharingFrames, AreThoseOfHostBitForBit) {
    const reference::Variant& variant = GetParam();
    std::vector<std::vector<std::byte>> expected;
    {
        BoxRun host(*context, variant.caps, variant.options, "host");
        for (int i = 0; i < 3; ++i) expected.push_back(host.frame(kSmall, i));
        EXPECT_GT(host.opened.transport.cost().hostBytes, 0u);
    }
    for (const char* events : {"", "1"}) {
        set("EVENTS", events);
        BoxRun shared(*context, variant.caps, variant.options, "gl-sharing");
        ASSERT_EQ(shared.opened.transport.kind(), TransportKind::GlSharing);
        for (int i = 0; i < 3; ++i) test::expectSame(shared.frame(kSmall, i), expected[std::size_t(i)]);
        EXPECT_EQ(shared.opened.transport.cost().hostBytes, 0u);
        EXPECT_EQ(shared.opened.transport.hostImages(), nullptr);
    }
    const auto lines = layerLines();
    EXPECT_THAT(violationsOf(lines), IsEmpty());
    EXPECT_EQ(countOf(lines, "acquire 9"), 6);  // five surfaces of the camera, four of the lights
    EXPECT_EQ(countOf(lines, "release 9"), 6);
    EXPECT_EQ(countOf(lines, "fence"), 4);  // the second run's: one of the probe, one a frame
    // A driver may keep the image that a kernel's argument named last: one a run.
    EXPECT_GE(countOf(lines, "destroy"), countOf(lines, "create") - 2);
}

std::vector<reference::Variant> variants() {
    std::vector<reference::Variant> some = reference::defaultVariants();
    for (const char* storage : {"image", "planar", "packed"}) {
        for (int lanes : {1, 8}) {
            reference::Variant v = some.at(0);
            v.options.lanes = lanes;
            v.options.storage = storage;
            v.name += "_lanes" + std::to_string(lanes) + "_" + storage;
            some.push_back(v);
        }
    }
    return some;
}
INSTANTIATE_TEST_SUITE_P(All, GlSharingFrames, ::testing::ValuesIn(variants()),
                         [](const auto& variant) { return variant.param.name; });

TEST_F(GlSharing, ResizedFramesAreSharedAnew) {
    // GL gives names of deleted textures out again: what stood for the old ones must be gone.
    const Extent extents[] = {kSmall, kLarge, kSmall, kLarge};
    {
        BoxRun host(*context, device(), {}, "host"), shared(*context, device(), {}, "gl-sharing");
        for (int i = 0; i < 4; ++i) {
            // Two renderers with one storage in the context: each run sets its own before it draws.
            context->setTextureStorage(&host.opened.transport);
            const auto expected = host.frame(extents[i], i);
            context->setTextureStorage(&shared.opened.transport);
            test::expectSame(shared.frame(extents[i], i), expected);
        }
    }
    EXPECT_THAT(violationsOf(layerLines()), IsEmpty());
    EXPECT_EQ(countOf(layerLines(), "create 61x35"), 2 * 5);
    EXPECT_EQ(countOf(layerLines(), "create 96x40"), 2 * 5);
}

TEST_F(GlSharing, TexturesThatCameAndWentUnseenAreSharedAnew) {
    {
        BoxRun run(*context, device(), {}, "gl-sharing");
        run.frame(kSmall, 0);
        run.draw(Camera{}, kLarge);
        run.frame(kSmall, 1);  // the first frame's extent, formats and perhaps names, but other textures
    }
    EXPECT_THAT(violationsOf(layerLines()), IsEmpty());
    EXPECT_EQ(countOf(layerLines(), "create 61x35"), 2 * 5);
}

TEST_F(GlSharing, OpenGlHasDrawnBeforeOpenClReads) {
    // Between drawing and acquire: glFinish; with cl_khr_gl_event a fence, flushed, and no wait on the host.
    static std::vector<std::string> calls;
    static void (*finish)();
    static void* (*fenceSync)(unsigned, unsigned);
    static void (*flush)();
    GlContextHandle watched = context->handle();
    const GlGetProcAddress find = watched.getProcAddress;
    finish = reinterpret_cast<decltype(finish)>(find("glFinish"));
    fenceSync = reinterpret_cast<decltype(fenceSync)>(find("glFenceSync"));
    flush = reinterpret_cast<decltype(flush)>(find("glFlush"));
    watched.getProcAddress = [find](const char* name) -> void* {
        const std::string function = name;
        if (function == "glFinish")
            return reinterpret_cast<void*>(static_cast<void (*)()>([] {
                calls.emplace_back("finish");
                finish();
            }));
        if (function == "glFenceSync")
            return reinterpret_cast<void*>(static_cast<void* (*)(unsigned, unsigned)>([](unsigned a, unsigned b) {
                calls.emplace_back("fence");
                return fenceSync(a, b);
            }));
        if (function == "glFlush")
            return reinterpret_cast<void*>(static_cast<void (*)()>([] {
                calls.emplace_back("flush");
                flush();
            }));
        return find(name);
    };
    for (const char* events : {"", "1"}) {
        set("EVENTS", events);
        BoxRun run(*context, device(), {}, "gl-sharing", watched);
        calls.clear();
        run.frame(kSmall, 0);
        if (*events)
            EXPECT_THAT(calls, ElementsAre("fence", "flush"));
        else
            EXPECT_THAT(calls, ElementsAre("finish"));
        EXPECT_EQ(run.opened.transport.cost().waitMs > 0.0, !*events);
    }
}

// A driver with GL_ARB_cl_event that takes no event of this context: asked once, and its error is nobody else's.
TEST_F(GlSharing, EventsThatOpenGlRefusesAreWaitedFor) {
    static int asked;
    static GlGetProcAddress find;
    asked = 0;
    GlContextHandle refusing = context->handle();
    find = refusing.getProcAddress;
    refusing.getProcAddress = [](const char* name) -> void* {
        const std::string function = name;
        if (function == "glGetStringi")  // the last of its extensions is another
            return reinterpret_cast<void*>(
                static_cast<const unsigned char* (*)(unsigned, unsigned)>([](unsigned what, unsigned index) {
                    int count = 0;
                    reinterpret_cast<PFNGLGETINTEGERVPROC>(find("glGetIntegerv"))(GL_NUM_EXTENSIONS, &count);
                    return what == GL_EXTENSIONS && int(index) == count - 1
                               ? reinterpret_cast<const unsigned char*>("GL_ARB_cl_event")
                               : reinterpret_cast<PFNGLGETSTRINGIPROC>(find("glGetStringi"))(what, index);
                }));
        if (function == "glCreateSyncFromCLeventARB")
            return reinterpret_cast<void*>(
                static_cast<void* (*)(cl_context, cl_event, unsigned)>([](cl_context, cl_event, unsigned) -> void* {
                    ++asked;
                    reinterpret_cast<PFNGLCLEARPROC>(find("glClear"))(1);  // no such bit: GL_INVALID_VALUE
                    return nullptr;
                }));
        return find(name);
    };
    BoxRun host(*context, device(), {}, "host");
    const auto expected = host.frame(kSmall, 0);
    set("EVENTS", "1");
    BoxRun run(*context, device(), {}, "gl-sharing", refusing);
    test::expectSame(run.frame(kSmall, 0), expected);
    run.frame(kSmall, 1);
    EXPECT_EQ(asked, 1);
    EXPECT_THAT(violationsOf(layerLines()), IsEmpty());
}

TEST_F(GlSharing, AnotherDeviceThanOpenGlsIsNamed) {
    set("DEVICE", "none");
    const std::string message = deviceErrorOf([&] { openForGl(device(), {}, context->handle(), "gl-sharing"); });
    EXPECT_THAT(message,
                AllOf(StartsWith("transport gl-sharing: OpenGL draws on \"" + context->description().renderer + "\""),
                      HasSubstr("not \"" + device().name + "\"")));
    const GlDevice chosen = openForGl(device(), {}, context->handle());
    EXPECT_EQ(chosen.transport.kind(), TransportKind::Host);
    EXPECT_THAT(chosen.transport.reason(), HasSubstr("gl-sharing: OpenGL draws on"));
}

TEST_F(GlSharing, ContextsOfOsmesaAreNotShared) {
    const auto osmesa = raster::test::otherContext("osmesa");
    GlContextHandle handle = osmesa ? osmesa->handle() : context->handle();
    if (!osmesa) {  // what its handle would be
        handle.platform = GlPlatformKind::Other;
        handle.display = nullptr;
    }
    EXPECT_EQ(handle.platform, GlPlatformKind::Other);
    EXPECT_THAT(deviceErrorOf([&] { openForGl(device(), {}, handle, "gl-sharing"); }),
                StartsWith("transport gl-sharing: OpenCL can share with contexts of EGL and GLX"));
    EXPECT_EQ(openForGl(device(), {}, handle).transport.kind(), TransportKind::Host);
}

TEST_F(GlSharing, ContextsOfGlxAreNamedAsSuch) {
    // No X server here: the layer takes the EGL context under GLX's property, and says so.
    GlContextHandle glx = context->handle();
    glx.platform = GlPlatformKind::Glx;
    openForGl(device(), {}, context->handle(), "gl-sharing");
    EXPECT_EQ(countOf(layerLines(), "context egl"), 1);
    EXPECT_EQ(openForGl(device(), {}, glx, "gl-sharing").transport.kind(), TransportKind::GlSharing);
    EXPECT_EQ(countOf(layerLines(), "context glx"), 1);
}

TEST_F(GlSharing, AnUnknownNameIsRefused) {
    EXPECT_THROW(openForGl(device(), {}, context->handle(), "glsharing"), UsageError);
}

TEST_F(GlSharing, AFailureInMidRunGoesOnWithHost) {
    std::vector<std::vector<std::byte>> expected;
    {
        BoxRun host(*context, device(), {}, "host");
        for (int i = 0; i < 3; ++i) expected.push_back(host.frame(i < 2 ? kSmall : kLarge, i));
    }
    // The probe acquires once and shares three textures, each frame acquires once, the first shares nine textures.
    for (const char* failure : {"acquire:3", "release:3", "create:14"}) {
        SCOPED_TRACE(failure);
        const int lastShared = std::string(failure) == "create:14" ? 1 : 0;
        set("FAIL", failure);
        BoxRun run(*context, device(), {}, "auto");
        ASSERT_EQ(run.opened.transport.kind(), TransportKind::GlSharing);
        const test::LogCapture warnings(LogLevel::Warning);
        for (int i = 0; i < 3; ++i) {
            test::expectSame(run.frame(i < 2 ? kSmall : kLarge, i), expected[std::size_t(i)]);
            EXPECT_EQ(run.opened.transport.kind(), i <= lastShared ? TransportKind::GlSharing : TransportKind::Host);
        }
        ASSERT_EQ(warnings.lines.size(), 1u);
        EXPECT_THAT(warnings.lines[0], AllOf(StartsWith("transport gl-sharing: "), HasSubstr("CL_OUT_OF_RESOURCES"),
                                             HasSubstr("; going on with host")));
    }
}

TEST_F(GlSharing, AFailureInMidRunEndsARunThatAskedForIt) {
    set("FAIL", "acquire:3");
    BoxRun run(*context, device(), {}, "gl-sharing");
    run.frame(kSmall, 0);
    EXPECT_THAT(deviceErrorOf([&] { run.frame(kSmall, 1); }),
                AllOf(StartsWith("transport gl-sharing: acquiring textures: "), HasSubstr("CL_OUT_OF_RESOURCES")));
}

TEST_F(GlSharing, WhatFailsTheRoundTripIsNotChosen) {
    set("FAIL", "release:1");
    const GlDevice chosen = openForGl(device(), {}, context->handle());
    EXPECT_EQ(chosen.transport.kind(), TransportKind::Host);
    EXPECT_THAT(chosen.transport.reason(), HasSubstr("gl-sharing: releasing textures: "));
}

/// The whole program.
class GlSharingProgram : public GlSharing {
protected:
    test::Result render(const std::string& name, const std::string& transport,
                        const std::vector<std::string>& environment = {}) const {
        std::vector<std::string> all{std::string("OPENCL_LAYERS=") + EARTHSHINE_GL_SHARING_LAYER};
        all.insert(all.end(), environment.begin(), environment.end());
        return test::runEarthshine({"render",
                                    EARTHSHINE_DATA_DIR "/moving.glb",
                                    "--gl",
                                    raster::test::testedKind(),
                                    "--size",
                                    "65x37",
                                    "--rsm-size",
                                    "32",
                                    "--shadow-size",
                                    "64",
                                    "--frames",
                                    "3",
                                    "--path",
                                    "orbit",
                                    "--animate",
                                    "on",
                                    "--preset",
                                    "balanced",
                                    "--aov",
                                    "all",
                                    "-o",
                                    (folder / (name + ".###.exr")).string(),
                                    "--report",
                                    (folder / (name + ".json")).string(),
                                    "--transport",
                                    transport},
                                   all);
    }
    void expectSamePictures(const std::string& name) const {
        for (const char* frame : {".000", ".001", ".002"})
            for (const char* ending : {".exr", ".png", ".rsm.exr", ".shadow.exr"})
                EXPECT_TRUE(test::readText(folder / (name + frame + ending)) ==
                            test::readText(folder / (std::string("host") + frame + ending)))
                    << frame << ending;
    }
};

TEST_F(GlSharingProgram, RendersTheSequenceOfHost) {
    ASSERT_EQ(render("host", "host").exitCode, 0);
    const test::Result result = render("auto", "auto");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    expectSamePictures("auto");
    EXPECT_THAT(result.out, HasSubstr("transport   gl-sharing (a round trip went well"));
    EXPECT_THAT(test::readText(folder / "auto.json"),
                AllOf(HasSubstr("\"transport\": \"gl-sharing\""), HasSubstr("\"hostBytes\": 0")));
    EXPECT_THAT(violationsOf(layerLines()), IsEmpty());
    EXPECT_EQ(countOf(layerLines(), "acquire 9"), 4);  // one frame of warm-up

    const test::Result failing = render("fails", "auto", {"EARTHSHINE_LAYER_FAIL=acquire:4"});
    EXPECT_EQ(failing.exitCode, 0) << failing.err;
    EXPECT_THAT(failing.err, AllOf(HasSubstr("earthshine: warning: transport gl-sharing: acquiring textures: "),
                                   HasSubstr("; going on with host\n")));
    EXPECT_THAT(test::readText(folder / "fails.json"), HasSubstr("\"transport\": \"host\""));
    expectSamePictures("fails");
}

TEST_F(GlSharingProgram, StopsInOneLineIfItWasAskedFor) {
    const test::Result result = render("fails", "gl-sharing", {"EARTHSHINE_LAYER_FAIL=acquire:4"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.err, HasSubstr("earthshine: transport gl-sharing: acquiring textures: "));
    EXPECT_THAT(result.err, Not(HasSubstr("going on")));
    EXPECT_THAT(folder.names(), Not(Contains("fails.json")));
}

}  // namespace
}  // namespace earthshine
