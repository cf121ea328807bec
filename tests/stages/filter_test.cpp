// The a-trous filter against plain doubles in each of its forms, at every width and storage, on every device here.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <glm/geometric.hpp>

#include "earthshine/error.hpp"
#include "earthshine/pipeline.hpp"
#include "interop/host_transport.hpp"
#include "pipeline/make_params.hpp"
#include "reference/denoiser_reference.hpp"
#include "reference/device_variants.hpp"
#include "reference/synthetic_frame.hpp"
#include "stages/atrous_stage.hpp"
#include "stages/denoiser_fixture.hpp"
#include "stages/frame_params.hpp"
#include "support/surface_pixels.hpp"

namespace earthshine {
namespace {

using reference::filterPass;

class Filter : public Denoiser {};

void compareFilters(const Device& device, Extent extent, const std::vector<FilterKernel>& kernels) {
    const FrameImages frame = slidingWalls(extent);
    Pipeline raw(device);
    raw.setFrame(frame.inputs());
    Settings noise = fewSamples();
    noise.animatesNoise = false;
    raw.run(noise);
    const std::vector<glm::dvec3> noisy = colors(raw.read(Output::IndirectIrradiance));
    for (const FilterKernel kernel : kernels) {
        for (const FilterWeights weights : {FilterWeights::Plane, FilterWeights::Depth}) {
            SCOPED_TRACE(testing::Message()
                         << kFilterKernelNames[int(kernel)] << ", " << kFilterWeightsNames[int(weights)]);
            Settings settings = noise;
            settings.filterIterations = 2;
            settings.filterKernel = kernel;
            settings.filterWeights = weights;
            std::vector<glm::dvec3> expected = noisy;
            for (const int step : {1, 2}) {
                if (kernel == FilterKernel::Separable) {
                    expected = filterPass(frame, expected, settings, 2, 0, step);
                    expected = filterPass(frame, expected, settings, 0, 2, step);
                } else {
                    const int radius = kernel == FilterKernel::Square3x3 ? 1 : 2;
                    expected = filterPass(frame, expected, settings, radius, radius, step);
                }
            }
            raw.run(settings);
            expectNear(raw.read(Output::IndirectIrradiance), expected);
        }
    }
}

TEST_P(Filter, FiltersInEveryForm) {
    for (const Extent extent : {Extent{53, 21}, Extent{7, 3}, Extent{1, 1}}) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        compareFilters(device_, extent, {FilterKernel::Separable, FilterKernel::Square3x3, FilterKernel::Square5x5});
    }
    compareFilters(device_, {191, 347}, {FilterKernel::Separable});
}

// A row and a column in one launch are the two passes, at every step, size and feedback, whatever groups are asked for.
// (Packed pixels round between the two.)
TEST_P(Filter, PairsAreTwoPasses) {
    DeviceOptions options = GetParam().options;
    options.filterPairs = 0;
    const Device twoPasses(GetParam().caps, options);
    options.filterPairs = 1;
    options.localSizePx[0] = options.localSizePx[1] = 16;  // a strip's rows, for every item, would be more than a stack
    const Device pairs(GetParam().caps, options);
    for (const Extent extent : {Extent{1, 1}, Extent{7, 3}, Extent{97, 141}}) {
        const FrameImages frame = slidingWalls(extent);
        for (const int feedback : {0, 2}) {
            SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx << ", feedback " << feedback);
            Settings settings = settingsOf(Preset::Balanced);
            settings.filterIterations = 7;
            settings.feedback = feedback;
            Pipeline two(twoPasses), paired(pairs);
            for (Pipeline* pipeline : {&two, &paired}) {
                pipeline->setFrame(frame.inputs());
                for (int i = 0; i < 3; ++i) pipeline->run(settings);
            }
            expectNear(paired.read(Output::IndirectIrradiance), colors(two.read(Output::IndirectIrradiance)));
        }
    }
}

/// What the stage alone is given: random surfaces, a fifth sky, lit in spots.
struct PairInputs {
    HostImage irradiance, normalWs, depth, length;
    AtrousParams params{};
};

PairInputs pairInputs(Extent extent, int stepPx, bool limitsLone) {
    std::mt19937 random(70);
    const auto uniform = [&random] { return float(double(random()) / 4294967296.0); };
    PairInputs p{HostImage(PixelFormat::RGBA32F, extent), HostImage(PixelFormat::RGBA32F, extent),
                 HostImage(PixelFormat::R32F, extent), HostImage(PixelFormat::R32F, extent)};
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            const bool isSky = uniform() < 0.2f, isBright = uniform() < 0.05f;
            const glm::vec3 n = glm::normalize(glm::vec3(uniform() - 0.5f, uniform() - 0.5f, 4.0f));
            const float depth = 5.0f + 0.01f * uniform(), frames = 1.0f + 30.0f * uniform();
            for (int c = 0; c < 3; ++c) {
                const float e = uniform() * (isBright ? 100.0f : 1.0f);
                if (!isSky) p.irradiance.pixel(x, y)[c] = e, p.normalWs.pixel(x, y)[c] = n[c];
            }
            if (!isSky) *p.depth.pixel(x, y) = depth, *p.length.pixel(x, y) = frames;
        }
    }
    reference::SyntheticOptions options;
    options.extent = extent;
    FrameGeometry geometry;
    geometry.cameraRays = makeViewRays(reference::makeSyntheticFrame(options).camera, extent);
    geometry.cameraRays.ray = {0, 0, -1, 0};
    geometry.cameraRays.rayDx = {1e-3f, 0, 0, 0};
    geometry.cameraRays.rayDy = {0, -1e-3f, 0, 0};
    geometry.extent = extent;
    Settings settings = settingsOf(Preset::Balanced);
    settings.filterIterations = 1;
    settings.filterNormal = 0.5f;
    settings.filterFade = 8.0f;
    p.params = makeParams(settings, geometry).filterPasses.front();
    p.params.stepPx = stepPx;
    p.params.inverseStep = 1.0f / float(stepPx);
    p.params.limitsLone = limitsLone;
    p.normalWs = toHalf(p.normalWs.view());
    return p;
}

// Groups of 128 and their pieces against two passes: pictures wider than a group, lower than a step, whose last rows do
// not fill a piece.
TEST_P(Filter, PairsAreTwoPassesAtEveryStep) {
    HostTransport transport(device_);
    AtrousStage stage(device_);
    for (const Extent extent : {Extent{1, 1}, Extent{1, 70}, Extent{127, 5}, Extent{128, 3}, Extent{129, 1},
                                Extent{385, 70}, Extent{260, 301}}) {
        const auto three = [&](PixelFormat format) { return Surface(device_, format, extent); };
        const Surface in = three(PixelFormat::RGBA32F), normalWs = three(PixelFormat::RGBA16F);
        const Surface depth = three(PixelFormat::R32F), length = three(PixelFormat::R32F);
        const Surface between = three(PixelFormat::RGBA32F), two = three(PixelFormat::RGBA32F);
        const Surface paired = three(PixelFormat::RGBA32F);
        for (const int step : {1, 2, 3, 5, 16, 31, 32, 33, 64, 248}) {
            for (const bool limitsLone : {false, true}) {
                SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx << ", step " << step
                                                << ", limitsLone " << limitsLone);
                const PairInputs p = pairInputs(extent, step, limitsLone);
                transport.enqueueImage(p.irradiance.view(), in, 0);
                transport.enqueueImage(p.normalWs.view(), normalWs, 0);
                transport.enqueueImage(p.depth.view(), depth, 0);
                transport.enqueueImage(p.length.view(), length, 0);
                AtrousParams column = p.params;
                std::swap(column.radiusX, column.radiusY);
                stage.enqueue({in, normalWs, depth, length, {}, between}, p.params);
                stage.enqueue({between, normalWs, depth, length, {}, two}, column);
                const HostImage expected = test::readSurface(device_, two);  // waits: nothing of p is read after it
                transport.release();
                const AtrousStage::Images images{in, normalWs, depth, length, {}, paired};
                if (!stage.canPair(p.params)) {
                    EXPECT_EQ(device_.tuning().lanes, 1);
                    EXPECT_GT(step, ATROUS_PAIR_MOST_STEP);
                    EXPECT_THROW(stage.enqueuePair(images, p.params), DeviceError);
                    continue;
                }
                stage.enqueuePair(images, p.params);
                expectNear(test::readSurface(device_, paired), colors(expected));
                if (HasFatalFailure()) return;
            }
        }
    }
}

// Normals that are not unit: a filter still makes means, of which none is more than the most.
TEST_P(Filter, LongNormalsMakeNoLight) {
    FrameImages frame = slidingWalls({53, 37});
    HostImage normals = toFloat(frame.normalWs.view());
    constexpr float kLengths[] = {0.7f, 40.0f, 1000.0f, 60000.0f};
    for (int i = 0; i < 53 * 37; ++i)
        if (i % 5 == 0)
            for (int c = 0; c < 3; ++c) normals.pixel(0, 0)[4 * i + c] *= kLengths[i / 5 % 4];
    frame.normalWs = toHalf(normals.view());
    for (const int filterPairs : {0, 1}) {
        DeviceOptions options = GetParam().options;
        options.filterPairs = filterPairs;
        Pipeline pipeline{Device(GetParam().caps, options)};
        pipeline.setFrame(frame.inputs());
        Settings settings = fewSamples();
        settings.animatesNoise = false;
        pipeline.run(settings);
        double most = 0.0;
        for (const glm::dvec3& e : colors(pipeline.read(Output::IndirectIrradiance)))
            most = std::max({most, e.x, e.y, e.z});
        settings.filterIterations = 3;
        settings.filterNormal = 0.05f;
        for (const FilterWeights weights : {FilterWeights::Plane, FilterWeights::Depth}) {
            settings.filterWeights = weights;
            pipeline.run(settings);
            for (const glm::dvec3& e : colors(pipeline.read(Output::IndirectIrradiance)))
                for (int c = 0; c < 3; ++c) {
                    ASSERT_TRUE(std::isfinite(e[c]));
                    ASSERT_LE(e[c], most * 1.001) << kFilterWeightsNames[int(weights)] << ", pairs " << filterPairs;
                }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Filter, testing::ValuesIn(reference::quickVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
