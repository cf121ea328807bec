// How outputs follow from one another, and what the sky is: L = albedo / pi E + emission, and nothing falls on sky.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "earthshine/pipeline.hpp"
#include "reference/device_variants.hpp"
#include "reference/synthetic_frame.hpp"

namespace earthshine {
namespace {

// Depth alone says what is sky: whatever else its pixels hold, nothing falls on them.
void fillSky(FrameImages& frame) {
    const Extent extent = frame.depth.extent();
    for (int i = 0; i < extent.widthPx * extent.heightPx; ++i) {
        if (frame.depth.pixel(0, 0)[i] > 0.0f) continue;
        for (int c = 0; c < 4; ++c) {
            reinterpret_cast<std::uint16_t*>(frame.normalWs.data())[4 * i + c] = halfFromFloat(c == 1 ? 1.0f : 0.25f);
            reinterpret_cast<std::uint16_t*>(frame.albedo.data())[4 * i + c] = halfFromFloat(0.5f);
        }
    }
}

class Compose : public testing::TestWithParam<reference::Variant> {
protected:
    Pipeline pipeline_{Device(GetParam().caps, GetParam().options)};
};

TEST_P(Compose, OutputsFollowFromIrradiance) {
    for (const bool hasEmission : {true, false}) {
        reference::SyntheticOptions options;
        options.emission = hasEmission;
        FrameImages frame = reference::makeSyntheticFrame(options);
        fillSky(frame);
        for (const Estimator estimator : {Estimator::Disk, Estimator::Sum}) {
            Settings settings;
            settings.estimator = estimator;
            settings.sampleCount = 8;
            pipeline_.setFrame(frame.inputs());
            pipeline_.run(settings);
            const HostImage directIrradiance = pipeline_.read(Output::DirectIrradiance);
            const HostImage indirectIrradiance = pipeline_.read(Output::IndirectIrradiance);
            const HostImage direct = pipeline_.read(Output::Direct), indirect = pipeline_.read(Output::Indirect);
            const HostImage color = pipeline_.read(Output::Color);
            const HostImage albedo = toFloat(frame.albedo.view());
            const double rounding = reference::surfaceRounding(GetParam());
            const HostImage emission =
                hasEmission ? toFloat(frame.emission.view()) : HostImage(albedo.format(), albedo.extent());
            int skyPixels = 0;
            for (int y = 0; y < options.extent.heightPx; ++y) {
                for (int x = 0; x < options.extent.widthPx; ++x) {
                    SCOPED_TRACE(testing::Message() << x << ", " << y);
                    const bool isSky = *frame.depth.pixel(x, y) == 0.0f;
                    skyPixels += isSky ? 1 : 0;
                    for (const HostImage* image : {&directIrradiance, &indirectIrradiance, &direct, &indirect, &color})
                        ASSERT_EQ(image->pixel(x, y)[3], isSky ? 0.0f : 1.0f);
                    for (int c = 0; c < 3; ++c) {
                        const double reflectance = double(albedo.pixel(x, y)[c]) / std::numbers::pi;
                        const auto eDirect = double(directIrradiance.pixel(x, y)[c]);
                        const auto eIndirect = double(indirectIrradiance.pixel(x, y)[c]);
                        const auto emitted = double(emission.pixel(x, y)[c]);
                        // Three roundings of 32 bits each, and two of surfaces.
                        const double bar = (3e-7 + 2.0 * rounding) * (emitted + reflectance * (eDirect + eIndirect));
                        ASSERT_NEAR(double(direct.pixel(x, y)[c]), reflectance * eDirect + emitted, bar);
                        ASSERT_NEAR(double(indirect.pixel(x, y)[c]), reflectance * eIndirect, bar);
                        ASSERT_NEAR(double(color.pixel(x, y)[c]),
                                    double(direct.pixel(x, y)[c]) + double(indirect.pixel(x, y)[c]), bar);
                        if (!isSky) continue;
                        ASSERT_EQ(eDirect, 0.0);
                        ASSERT_EQ(eIndirect, 0.0);
                        ASSERT_EQ(color.pixel(x, y)[c], emission.pixel(x, y)[c]);  // the background, untouched
                    }
                }
            }
            EXPECT_GT(skyPixels, 20);
        }
    }
}

TEST_P(Compose, WithoutSurfacesOrLightsNothingIsLit) {
    reference::SyntheticOptions onlySky, noLights;
    onlySky.skyFraction = 1.0;
    noLights.lightCount = 0;
    for (const reference::SyntheticOptions& options : {onlySky, noLights}) {
        SCOPED_TRACE(testing::Message() << options.lightCount << " lights");
        FrameImages frame = reference::makeSyntheticFrame(options);
        fillSky(frame);
        const HostImage emission = toFloat(frame.emission.view());
        pipeline_.setFrame(frame.inputs());
        for (const Estimator estimator : {Estimator::Disk, Estimator::Sum}) {
            Settings settings;
            settings.estimator = estimator;
            pipeline_.run(settings);
            const HostImage direct = pipeline_.read(Output::DirectIrradiance);
            const HostImage indirect = pipeline_.read(Output::IndirectIrradiance);
            const HostImage color = pipeline_.read(Output::Color);
            for (int y = 0; y < options.extent.heightPx; ++y) {
                for (int x = 0; x < options.extent.widthPx; ++x) {
                    for (int c = 0; c < 3; ++c) {
                        ASSERT_EQ(direct.pixel(x, y)[c], 0.0f);
                        ASSERT_EQ(indirect.pixel(x, y)[c], 0.0f);
                        ASSERT_EQ(color.pixel(x, y)[c], emission.pixel(x, y)[c]);
                    }
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Compose, testing::ValuesIn(reference::quickVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
