// The a-trous filter against plain doubles in each of its forms, at every width and storage, on every device here.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "earthshine/pipeline.hpp"
#include "reference/denoiser_reference.hpp"
#include "reference/device_variants.hpp"
#include "stages/denoiser_fixture.hpp"

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

// A row and a column in one launch are the two passes, at every step, size and feedback. (Packed pixels round between
// the two.)
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
