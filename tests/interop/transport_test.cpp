// Transports on the devices that are really here, without a layer: what opens gives the frame of `host`, bit for bit,
// and nothing goes through the host's memory; what does not says why. It runs on a GPU, too, from this one file:
//   EARTHSHINE_TEST_GL=egl-device            a GPU's own OpenGL ("egl", llvmpipe's, without it)
//   EARTHSHINE_TEST_DEVICES=TEXT             OpenCL devices whose platform or name holds it
//   EARTHSHINE_TEST_TRANSPORT=NAME           this transport must open
//   EARTHSHINE_TEST_FRAMES=N                 frames of 1920 x 1080 that are timed [5 of 64 x 36]

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "interop/interop_support.hpp"
#include "reference/device_variants.hpp"

namespace earthshine {
namespace {

using test::BoxRun;
using test::deviceErrorOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kSharing[] = {"external-memory", "gl-sharing"};

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

class Transports : public ::testing::TestWithParam<reference::Variant> {
protected:
    raster::GlContext& context() { return raster::test::sharedContext(); }

    /// A run over this transport; none, with its reason printed and checked, if it cannot be had.
    std::unique_ptr<BoxRun> open(const std::string& transport, bool profiles = false) {
        reference::Variant variant = GetParam();
        variant.options.profiling = profiles;
        try {
            return std::make_unique<BoxRun>(context(), variant.caps, variant.options, transport);
        } catch (const DeviceError& error) {
            const std::string reason = error.what();
            fmt::print("{}\n", reason);
            EXPECT_THAT(reason, StartsWith("transport " + transport + ": "));
            EXPECT_EQ(reason.find('\n'), std::string::npos) << "not one line";
            EXPECT_NE(environment("EARTHSHINE_TEST_TRANSPORT"), transport) << "must open";
            const auto& listed = variant.caps.transports;
            if (std::find(listed.begin(), listed.end(), transport) == listed.end()) {
                EXPECT_THAT(reason, HasSubstr(": no cl_khr_"));
            }
            return nullptr;
        }
    }
};

TEST_P(Transports, AutoIsTheFirstThatOpens) {
    const GlDevice chosen = openForGl(GetParam().caps, GetParam().options, context().handle());
    fmt::print("{} and \"{}\": transport {}: {}\n", context().description().renderer, GetParam().caps.name,
               chosen.transport.name(), chosen.transport.reason());
    for (const char* transport : kSharing) {
        if (chosen.transport.name() == std::string(transport)) return;
        EXPECT_THAT(chosen.transport.reason(), HasSubstr(std::string(transport) + ": "));
        EXPECT_EQ(open(transport), nullptr);
    }
    EXPECT_EQ(chosen.transport.kind(), TransportKind::Host);
}

TEST_P(Transports, FramesAreThoseOfHostBitForBit) {
    // Sizes change on the way: textures are made anew, and shared anew.
    constexpr Extent kExtents[] = {{61, 35}, {61, 35}, {640, 361}, {61, 35}, {1, 1}};
    std::vector<std::vector<std::byte>> expected;
    {
        const auto host = open("host");
        for (int i = 0; i < int(std::size(kExtents)); ++i) expected.push_back(host->frame(kExtents[i], i));
        EXPECT_GT(host->opened.transport.cost().hostBytes, 0u);
    }
    for (const char* transport : kSharing) {
        SCOPED_TRACE(transport);
        const auto run = open(transport);
        if (!run) continue;
        for (int i = 0; i < int(std::size(kExtents)); ++i) {
            SCOPED_TRACE(i);
            test::expectSame(run->frame(kExtents[i], i), expected[std::size_t(i)]);
            EXPECT_EQ(run->opened.transport.cost().hostBytes, 0u);
        }
        EXPECT_EQ(run->opened.transport.hostImages(), nullptr);
    }
}

TEST_P(Transports, ManyFramesInARow) {
    // A semaphore that is not waited for, a texture that is drawn over while it is read: these show over many frames.
    constexpr Extent kExtent{320, 180};
    constexpr int kFrames = 40;
    for (const char* transport : kSharing) {
        SCOPED_TRACE(transport);
        const auto run = open(transport);
        if (!run) continue;
        const auto host = open("host");
        for (int i = 0; i < kFrames; ++i) {
            SCOPED_TRACE(i);
            context().setTextureStorage(&host->opened.transport);
            const auto expected = host->frame(kExtent, i);
            context().setTextureStorage(&run->opened.transport);
            test::expectSame(run->frame(kExtent, i), expected);
        }
    }
}

TEST_P(Transports, FrameTimes) {
    const std::string asked = environment("EARTHSHINE_TEST_FRAMES");
    const int frames = asked.empty() ? 5 : std::max(std::atoi(asked.c_str()), 1);
    const Extent extent = asked.empty() ? Extent{64, 36} : Extent{1920, 1080};
    std::vector<std::string> names{"host"};
    names.insert(names.end(), std::begin(kSharing), std::end(kSharing));
    for (const std::string& transport : names) {
        const auto run = open(transport, true);
        if (!run) continue;
        if (!asked.empty()) {
            run->rsmSizePx = 512;
            run->shadowSizePx = 2048;
            run->filterIterations = 5;
        }
        run->compute(extent, 0);  // compiles, allocates
        std::map<std::string, std::vector<double>> ms;
        for (int i = 1; i <= frames; ++i) {
            const auto start = std::chrono::steady_clock::now();
            run->compute(extent, i);
            const auto end = std::chrono::steady_clock::now();
            const TransportCost& cost = run->opened.transport.cost();
            ms["frame"].push_back(std::chrono::duration<double, std::milli>(end - start).count());
            ms["wait"].push_back(cost.waitMs);
            ms["acquire"].push_back(cost.acquireMs);
            ms["release"].push_back(cost.releaseMs);
            ms["device"].push_back(run->stageMs(""));
            ms["door"].push_back(run->stageMs("unpack") + run->stageMs("import_image"));
        }
        const auto median = [&ms](const char* name) {
            std::vector<double>& all = ms[name];
            const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
            std::nth_element(all.begin(), middle, all.end());
            return *middle;
        };
        fmt::print(
            "{}: \"{}\", {} x {}, medians of {} frames: {:.3f} ms, raster and all; wait {:.3f}, acquire {:.3f}, "
            "release "
            "{:.3f}; on the device {:.3f}, of it unpack or import_image {:.3f}; {} bytes through the host\n",
            transport, GetParam().caps.name, extent.widthPx, extent.heightPx, frames, median("frame"), median("wait"),
            median("acquire"), median("release"), median("device"), median("door"),
            run->opened.transport.cost().hostBytes);
        EXPECT_EQ(run->opened.transport.cost().hostBytes == 0, transport != "host");
    }
}

INSTANTIATE_TEST_SUITE_P(All, Transports, ::testing::ValuesIn(reference::defaultVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
