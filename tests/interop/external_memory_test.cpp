// Transport `external-memory` over a Vulkan, an OpenGL and an OpenCL layer that emulate what no driver here has, and
// keep its rules (fake_vulkan.cpp, fake_gl.cpp, external_memory_layer.cpp): the frame is that of `host`, bit for bit,
// no rule is broken, nothing is left behind, and whatever fails says so in one line. That the real drivers do what the
// specifications say is for transport_test.cpp on a machine that has them.

#include <dlfcn.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>

#include "image/temp_folder.hpp"
#include "interop/fake_gl.hpp"
#include "interop/interop_support.hpp"
#include "reference/device_variants.hpp"

namespace earthshine {
namespace {

using test::BoxRun;
using test::deviceErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// Before anything asks OpenCL for its platforms; and a library of this SONAME is found before any on the disk.
const bool kHasFakes = ::setenv("OPENCL_LAYERS", EARTHSHINE_EXTERNAL_MEMORY_LAYER, 1) == 0 &&
                       ::dlopen(EARTHSHINE_FAKE_VULKAN, RTLD_NOW | RTLD_LOCAL) != nullptr;

constexpr Extent kSmall{61, 35}, kLarge{96, 40};

class ExternalMemory : public ::testing::Test {
protected:
    ExternalMemory() {
        EXPECT_TRUE(kHasFakes);
        set("LOG", (folder / "layer.log").string());
        set("FAIL", "");
        set("DEVICE", "");
        context = raster::createContext(raster::test::testedKind());
        gl = test::withExternalObjects(context->handle());
    }
    ~ExternalMemory() override {
        context.reset();
        set("LOG", "");
    }
    static void set(const std::string& name, const std::string& value) {
        ::setenv(("EARTHSHINE_LAYER_" + name).c_str(), value.c_str(), 1);
    }
    std::vector<std::string> lines() const {
        std::istringstream stream(test::readText(folder / "layer.log"));
        std::vector<std::string> all;
        for (std::string line; std::getline(stream, line);) all.push_back(line);
        return all;
    }
    std::vector<std::string> violations() const {
        std::vector<std::string> some;
        for (const std::string& line : lines())
            if (line.starts_with("violation")) some.push_back(line);
        return some;
    }
    std::ptrdiff_t count(const std::string& line) const {
        const auto all = lines();
        return std::count(all.begin(), all.end(), line);
    }
    /// Nothing made by anyone is left.
    void expectNothingLeft() const {
        for (const char* kind : {"device", "image", "memory", "semaphore"})
            EXPECT_EQ(count(std::string("vk make ") + kind), count(std::string("vk destroy ") + kind)) << kind;
        EXPECT_EQ(count("gl memory"), count("gl memory deleted"));
    }
    /// Descriptors of what the fake Vulkan exported. A GPU's driver opens and keeps others as it likes.
    static std::ptrdiff_t openFiles() {
        std::ptrdiff_t count = 0;
        for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd")) {
            std::error_code closed;  // the iterator's own
            count += std::filesystem::read_symlink(file.path(), closed).string().starts_with("/memfd:fake-vulkan-");
        }
        return count;
    }
    static DeviceCaps device() { return reference::defaultVariants().at(0).caps; }
    std::vector<std::vector<std::byte>> framesOfHost(const std::vector<Extent>& extents,
                                                     const reference::Variant& variant) const {
        BoxRun host(*context, variant.caps, variant.options, "host");
        std::vector<std::vector<std::byte>> frames;
        for (std::size_t i = 0; i < extents.size(); ++i) frames.push_back(host.frame(extents[i], int(i)));
        return frames;
    }

    test::TempFolder folder;
    std::unique_ptr<raster::GlContext> context;
    GlContextHandle gl;
};

class ExternalMemoryFrames : public ExternalMemory, public ::testing::WithParamInterface<reference::Variant> {};

TEST_P(ExternalMemoryFrames, AreThoseOfHostBitForBit) {
    const reference::Variant& variant = GetParam();
    const std::vector<Extent> extents{kSmall, kSmall, kLarge, kSmall};
    const auto expected = framesOfHost(extents, variant);
    const auto filesBefore = openFiles();
    {
        BoxRun run(*context, variant.caps, variant.options, "auto", gl);
        ASSERT_EQ(run.opened.transport.kind(), TransportKind::ExternalMemory) << run.opened.transport.reason();
        EXPECT_EQ(run.opened.transport.reason(), "a round trip went well");
        for (std::size_t i = 0; i < extents.size(); ++i) {
            SCOPED_TRACE(i);
            test::expectSame(run.frame(extents[i], int(i)), expected[i]);
            EXPECT_EQ(run.opened.transport.cost().hostBytes, 0u);
            EXPECT_EQ(run.opened.transport.cost().waitMs, 0.0);
        }
        EXPECT_EQ(run.opened.transport.hostImages(), nullptr);
        EXPECT_EQ(test::finishCount(), 0);
    }
    EXPECT_THAT(violations(), IsEmpty());
    EXPECT_EQ(count("acquire 9"), 4);
    EXPECT_EQ(count("vk make memory"), 3 + 9 + 5 + 5);  // the probe's, a frame's, and five anew for each size
    EXPECT_EQ(count("semaphore let go"), 2);
    expectNothingLeft();
    const auto kept = count("import") - count("let go");
    EXPECT_LE(kept, 1) << "a driver may keep the image that a kernel's argument named last";
    EXPECT_EQ(openFiles(), filesBefore + kept);
}

std::vector<reference::Variant> variants() {
    std::vector<reference::Variant> some = reference::defaultVariants();
    reference::Variant v = some.at(0);
    v.options.lanes = 1;
    v.options.storage = "image";
    v.name += "_lanes1_image";
    some.push_back(v);
    return some;
}
INSTANTIATE_TEST_SUITE_P(All, ExternalMemoryFrames, ::testing::ValuesIn(variants()),
                         [](const auto& variant) { return variant.param.name; });

struct Failure {
    const char* failure;  ///< EARTHSHINE_LAYER_FAIL
    const char* words;    ///< of the one line that says so
};
void PrintTo(const Failure& failure, std::ostream* stream) {
    *stream << failure.failure;
}
class ExternalMemoryFails : public ExternalMemory, public ::testing::WithParamInterface<Failure> {};

TEST_P(ExternalMemoryFails, InOneLineAndLeavesNothing) {
    set("FAIL", GetParam().failure);
    const auto filesBefore = openFiles();
    const std::string message = deviceErrorOf([&] { openForGl(device(), {}, gl, "external-memory"); });
    EXPECT_THAT(message, AllOf(StartsWith("transport external-memory: "), HasSubstr(GetParam().words)));
    EXPECT_EQ(message.find('\n'), std::string::npos);
    expectNothingLeft();
    EXPECT_EQ(openFiles(), filesBefore);

    if (std::string(GetParam().failure).find(':') != std::string::npos)
        set("FAIL", std::string(GetParam().failure) + "#again");  // counts begin anew
    const GlDevice chosen = openForGl(device(), {}, gl);
    EXPECT_EQ(chosen.transport.kind(), TransportKind::Host);
    EXPECT_THAT(chosen.transport.reason(), HasSubstr(GetParam().words));
}

INSTANTIATE_TEST_SUITE_P(
    All, ExternalMemoryFails,
    ::testing::Values(
        Failure{"glExtension", "this OpenGL has no GL_EXT_semaphore_fd"},
        Failure{"vkCreateInstance:1", "vkCreateInstance: VK_ERROR_INCOMPATIBLE_DRIVER (-9)"},
        Failure{"extensions", "Vulkan's device has no VK_KHR_external_semaphore_fd"},
        Failure{"vkCreateDevice:1", "vkCreateDevice: VK_ERROR_INITIALIZATION_FAILED (-3)"},
        Failure{"vkCreateSemaphore:1", "vkCreateSemaphore: VK_ERROR_OUT_OF_HOST_MEMORY (-1)"},
        Failure{"vkCreateSemaphore:2", "vkCreateSemaphore: "},
        Failure{"vkGetSemaphoreFdKHR:2", "vkGetSemaphoreFdKHR: "},
        Failure{"glImportSemaphoreFdEXT:1", "glImportSemaphoreFdEXT: OpenGL error 0x0505"},
        Failure{"glImportSemaphoreFdEXT:2", "glImportSemaphoreFdEXT: "},
        Failure{"semaphore:2", "importing a semaphore: clCreateSemaphoreWithPropertiesKHR: CL_OUT_OF_RESOURCES (-5)"},
        Failure{"vkGetPhysicalDeviceImageFormatProperties2:1", "VK_ERROR_FORMAT_NOT_SUPPORTED (-11)"},
        Failure{"vkCreateImage:2", "vkCreateImage: "}, Failure{"vkAllocateMemory:3", "vkAllocateMemory: "},
        Failure{"vkBindImageMemory:1", "vkBindImageMemory: "}, Failure{"vkGetMemoryFdKHR:2", "vkGetMemoryFdKHR: "},
        Failure{"glImportMemoryFdEXT:1", "glImportMemoryFdEXT: OpenGL error 0x0505"},
        Failure{"glTexStorageMem2DEXT:3", "glTexStorageMem2DEXT of 131 x 67 RGBA32F: OpenGL error 0x0501"},
        Failure{"import:2",
                "importing a texture of 131 x 67 RGBA16F: clCreateImageWithProperties: CL_OUT_OF_RESOURCES"},
        Failure{"wait:1", "acquiring textures: clEnqueueWaitSemaphoresKHR: CL_OUT_OF_RESOURCES"},
        Failure{"acquire:1", "clEnqueueAcquireExternalMemObjectsKHR: "},
        Failure{"release:1", "releasing textures: clEnqueueReleaseExternalMemObjectsKHR: "},
        Failure{"signal:1", "clEnqueueSignalSemaphoresKHR: "}));

TEST_F(ExternalMemory, AnotherDeviceIsNotTaken) {
    set("DEVICE", "opencl");
    EXPECT_THAT(deviceErrorOf([&] { openForGl(device(), {}, gl, "external-memory"); }),
                HasSubstr("OpenGL draws on another device than \"" + device().name + "\""));
    set("DEVICE", "vulkan");
    EXPECT_THAT(deviceErrorOf([&] { openForGl(device(), {}, gl, "external-memory"); }),
                HasSubstr("Vulkan has no device with OpenGL's number 5a5a"));
    expectNothingLeft();
}

TEST_F(ExternalMemory, ADriverThatWantsOneLevelGetsIt) {
    set("DEVICE", "levels");
    EXPECT_EQ(openForGl(device(), {}, gl, "external-memory").transport.kind(), TransportKind::ExternalMemory);
    EXPECT_THAT(violations(), IsEmpty());
}

TEST_F(ExternalMemory, AFailureInMidRunGoesOnWithHost) {
    const std::vector<Extent> extents{kSmall, kLarge, kLarge};
    const auto expected = framesOfHost(extents, reference::defaultVariants().at(0));
    // The probe takes three images, the first frame nine; the second frame's size asks for the thirteenth.
    for (const char* failure :
         {"vkAllocateMemory:13", "glTexStorageMem2DEXT:14", "import:13", "acquire:3", "signal:3"}) {
        SCOPED_TRACE(failure);
        set("FAIL", failure);
        BoxRun run(*context, device(), {}, "auto", gl);
        ASSERT_EQ(run.opened.transport.kind(), TransportKind::ExternalMemory);
        const test::LogCapture warnings(LogLevel::Warning);
        for (std::size_t i = 0; i < extents.size(); ++i) {
            test::expectSame(run.frame(extents[i], int(i)), expected[i]);
            EXPECT_EQ(run.opened.transport.kind(), i == 0 ? TransportKind::ExternalMemory : TransportKind::Host);
        }
        ASSERT_EQ(warnings.lines.size(), 1u);
        EXPECT_THAT(warnings.lines[0],
                    AllOf(StartsWith("transport external-memory: "), HasSubstr("; going on with host")));
    }
    set("FAIL", "");
    expectNothingLeft();
}

TEST_F(ExternalMemory, ATextureOfAnotherOwnerIsNamed) {
    // A renderer that never asked for memory.
    BoxRun run(*context, device(), {}, "external-memory", gl);
    context->setTextureStorage(nullptr);
    EXPECT_THAT(deviceErrorOf([&] { run.frame(kSmall, 0); }), AllOf(StartsWith("transport external-memory: texture "),
                                                                    HasSubstr("did not ask Transport::allocate()")));
}

}  // namespace
}  // namespace earthshine
