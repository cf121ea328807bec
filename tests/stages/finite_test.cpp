// Whatever an input image holds, outputs are finite, and one bad pixel spoils no other. Judged by bits: a compiler may
// take x != x for false.

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <limits>

#include "earthshine/pipeline.hpp"
#include "reference/device_variants.hpp"
#include "reference/synthetic_frame.hpp"

namespace earthshine {
namespace {

// One more than 16 lanes in a row, so that every width has a tail.
constexpr Extent kExtent{17, 3};

reference::SyntheticOptions smallFrame() {
    reference::SyntheticOptions options;
    options.extent = kExtent;
    options.rsmSizePx = 5;
    options.shadowExtent = {6, 4};
    options.lightCount = 2;
    return options;
}

bool isFinite(float v) {
    return (std::bit_cast<std::uint32_t>(v) & 0x7f800000u) != 0x7f800000u;
}

constexpr Output kRadiometric[] = {Output::DirectIrradiance, Output::IndirectIrradiance, Output::Direct,
                                   Output::Indirect, Output::Color};

// Runs the frame, expects finite outputs, and gives them all, one after another.
std::vector<float> outputsOf(Pipeline& pipeline, const FrameImages& frame, const Settings& settings) {
    pipeline.setFrame(frame.inputs());
    pipeline.run(settings);
    std::vector<float> all;
    for (const Output output : kRadiometric) {
        const HostImage image = pipeline.read(output);
        const float* pixels = image.pixel(0, 0);
        all.insert(all.end(), pixels, pixels + 4 * kExtent.widthPx * kExtent.heightPx);
    }
    for (const float v : all) EXPECT_TRUE(isFinite(v)) << v;
    EXPECT_TRUE(isFinite(pipeline.exposure())) << pipeline.exposure();
    EXPECT_GT(pipeline.exposure(), 0.0f);
    pipeline.read(Output::Display);
    return all;
}

std::vector<float> outputsOf(Pipeline& pipeline, const FrameImages& frame, Estimator estimator, int rsmMinify = 1) {
    Settings settings;
    settings.estimator = estimator;
    settings.sampleCount = 7;
    settings.rsmMinify = rsmMinify;
    settings.animatesNoise = false;  // runs are compared with one another
    return outputsOf(pipeline, frame, settings);
}

// Everything that the denoiser can do, at once.
Settings denoising() {
    Settings settings = settingsOf(Preset::Balanced);
    settings.fireflyFactor = 4.0f;
    settings.filterLuminance = 4.0f;
    settings.feedback = 1;
    return settings;
}

// The turned kernel of a tile and its mean.
Settings tiled() {
    Settings settings;
    settings.sampleCount = 7;
    settings.rotation = Rotation::Tile;
    return settings;
}

// Sets of pixels that share texels.
Settings coherent() {
    Settings settings = settingsOf(Preset::Balanced);
    settings.rotation = Rotation::Coherent;
    return settings;
}

struct Input {
    const char* name;
    HostImage FrameImages::*image;
    bool isGBuffer;
};
constexpr Input kInputs[] = {{"albedo", &FrameImages::albedo, true},
                             {"normal", &FrameImages::normalWs, true},
                             {"depth", &FrameImages::depth, true},
                             {"emission", &FrameImages::emission, true},
                             {"motion", &FrameImages::motion, true},
                             {"RSM depth", &FrameImages::rsmDepth, false},
                             {"RSM normal", &FrameImages::rsmNormalWs, false},
                             {"RSM flux", &FrameImages::rsmFlux, false},
                             {"shadow depth", &FrameImages::shadowDepth, false}};

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kValues[] = {
    std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, -1.0f, 1e6f, std::numeric_limits<float>::max(),
    std::numeric_limits<float>::denorm_min()};

// Sets all channels of a pixel; halves hold what a half can of it.
void put(HostImage& image, int x, int y, float value) {
    if (image.format() != PixelFormat::RGBA16F) {
        for (int c = 0; c < channelCount(image.format()); ++c) image.pixel(x, y)[c] = value;
        return;
    }
    auto* halves = reinterpret_cast<std::uint16_t*>(image.data()) + 4 * (y * image.extent().widthPx + x);
    for (int c = 0; c < 4; ++c) halves[c] = halfFromFloat(value);
}

class Finite : public testing::TestWithParam<reference::Variant> {
protected:
    Pipeline pipeline_{Device(GetParam().caps, GetParam().options)};
};

TEST_P(Finite, OutputsWhateverInputsHold) {
    for (const Estimator estimator : {Estimator::Disk, Estimator::Sum}) {
        const std::vector<float> sound = outputsOf(pipeline_, reference::makeSyntheticFrame(smallFrame()), estimator);
        for (const Input& input : kInputs) {
            for (const float value : kValues) {
                SCOPED_TRACE(testing::Message() << input.name << " of " << value);
                FrameImages frame = reference::makeSyntheticFrame(smallFrame());
                put(frame.*input.image, 3, 1, value);
                const std::vector<float> spoiled = outputsOf(pipeline_, frame, estimator);
                if (!input.isGBuffer) continue;
                for (std::size_t i = 0; i < sound.size(); ++i) {
                    const std::size_t pixel = i / 4 % std::size_t(kExtent.widthPx * kExtent.heightPx);
                    if (pixel == std::size_t(kExtent.widthPx + 3)) continue;
                    ASSERT_EQ(std::bit_cast<std::uint32_t>(spoiled[i]), std::bit_cast<std::uint32_t>(sound[i]))
                        << "pixel " << pixel;
                }
            }
        }
    }

    // And whatever all pixels hold.
    for (const float value : kValues) {
        SCOPED_TRACE(value);
        FrameImages frame = reference::makeSyntheticFrame(smallFrame());
        for (const Input& input : kInputs) {
            HostImage& image = frame.*input.image;
            for (int y = 0; y < image.extent().heightPx; ++y)
                for (int x = 0; x < image.extent().widthPx; ++x) put(image, x, y, value);
        }
        for (const Estimator estimator : {Estimator::Disk, Estimator::Sum}) outputsOf(pipeline_, frame, estimator);
        outputsOf(pipeline_, frame, tiled());
        outputsOf(pipeline_, frame, coherent());
        if (GetParam().options.rsmRecords != 0) outputsOf(pipeline_, frame, Estimator::Sum, 2);
    }
}

// What history has once taken in, filters spread and frames pass on: junk must not live on in it.
TEST_P(Finite, HistoryForgetsJunk) {
    for (const FilterWeights weights : {FilterWeights::Plane, FilterWeights::Depth}) {
        Settings settings = denoising();
        settings.filterWeights = weights;
        for (const float value : kValues) {
            SCOPED_TRACE(value);
            pipeline_.forgetHistory();
            const FrameImages sound = reference::makeSyntheticFrame(smallFrame());
            FrameImages junk = reference::makeSyntheticFrame(smallFrame());
            for (const Input& input : kInputs) {
                HostImage& image = junk.*input.image;
                for (int y = 0; y < image.extent().heightPx; ++y)
                    for (int x = y % 2; x < image.extent().widthPx; x += 2) put(image, x, y, value);
            }
            // And light as bright as numbers go on a sound scene: its squares are what overflows.
            FrameImages blinding = reference::makeSyntheticFrame(smallFrame());
            for (int y = 0; y < blinding.rsmFlux.extent().heightPx; ++y)
                for (int x = 0; x < blinding.rsmFlux.extent().widthPx; ++x) put(blinding.rsmFlux, x, y, value);
            for (int i = 0; i < 2; ++i) outputsOf(pipeline_, sound, settings);
            for (int i = 0; i < 3; ++i) outputsOf(pipeline_, junk, settings);
            for (int i = 0; i < 3; ++i) outputsOf(pipeline_, blinding, settings);
            for (int i = 0; i < 3; ++i) outputsOf(pipeline_, sound, settings);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Finite, testing::ValuesIn(reference::quickVariants()),
                         [](const auto& variant) { return variant.param.name; });

// The whole pipeline once, as small as can be: what Oclgrind runs, at every width and storage.
class SmallFrame : public testing::TestWithParam<reference::Variant> {};

TEST_P(SmallFrame, Runs) {
    Pipeline pipeline{Device(GetParam().caps, GetParam().options)};
    for (const Estimator estimator : {Estimator::Disk, Estimator::Sum})
        outputsOf(pipeline, reference::makeSyntheticFrame(smallFrame()), estimator);
    outputsOf(pipeline, reference::makeSyntheticFrame(smallFrame()), tiled());
    outputsOf(pipeline, reference::makeSyntheticFrame(smallFrame()), coherent());
    if (GetParam().options.rsmRecords != 0)
        outputsOf(pipeline, reference::makeSyntheticFrame(smallFrame()), Estimator::Disk, 2);
    for (int i = 0; i < 2; ++i) outputsOf(pipeline, reference::makeSyntheticFrame(smallFrame()), denoising());
    for (const int divisor : {2, 4})
        for (const Upsampling upsampling : {Upsampling::Bilateral, Upsampling::Interpolate}) {
            Settings lower = denoising();
            lower.divisor = divisor;
            lower.upsampling = upsampling;
            outputsOf(pipeline, reference::makeSyntheticFrame(smallFrame()), lower);
        }
}

std::vector<reference::Variant> smallFrameVariants() {
    return std::getenv("EARTHSHINE_TEST_DEVICES") ? reference::allVariants() : reference::defaultVariants();
}

INSTANTIATE_TEST_SUITE_P(All, SmallFrame, testing::ValuesIn(smallFrameVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
