// From radiance to display bytes: exposure and tone curve against their formulas in doubles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "earthshine/pipeline.hpp"
#include "reference/device_variants.hpp"
#include "reference/frame_reference.hpp"
#include "reference/synthetic_frame.hpp"

namespace earthshine {
namespace {

class Display : public testing::TestWithParam<reference::Variant> {
protected:
    void run(const FrameImages& frame, const Settings& settings) {
        pipeline_.setFrame(frame.inputs());
        pipeline_.run(settings);
    }

    // The exposure that the pipeline's own picture asks for.
    double expectedExposure(const FrameImages& frame, double stops) {
        const HostImage color = pipeline_.read(Output::Color);
        std::vector<glm::dvec3> pixels;
        for (int y = 0; y < color.extent().heightPx; ++y)
            for (int x = 0; x < color.extent().widthPx; ++x)
                if (const float* p = color.pixel(x, y); *frame.depth.pixel(x, y) > 0.0f)
                    pixels.emplace_back(p[0], p[1], p[2]);
        return reference::automaticExposure(pixels, stops);
    }

    Pipeline pipeline_{Device(GetParam().caps, GetParam().options)};
};

// Logarithms with errors of some 1e-7 each, added in 32 bits: their mean is good to 1e-5, and so is 2^mean.
constexpr double kExposureBar = 1e-5;

TEST_P(Display, ExposureBringsTheMeanToMiddleGreyOrIsAPowerOfTwo) {
    for (const Extent extent : {Extent{37, 11}, Extent{1, 1}, Extent{7, 3}, Extent{191, 347}}) {
        reference::SyntheticOptions options;
        options.extent = extent;
        if (extent.widthPx == 1) options.skyFraction = 0.0;
        const FrameImages frame = reference::makeSyntheticFrame(options);
        for (const float stops : {0.0f, -3.5f, 12.0f}) {
            Settings settings;
            settings.sampleCount = 4;
            settings.exposureStops = stops;
            run(frame, settings);
            EXPECT_NEAR(double(pipeline_.exposure()) / expectedExposure(frame, double(stops)), 1.0, kExposureBar)
                << extent.widthPx << " x " << extent.heightPx << ", " << stops << " stops";
        }
    }

    const FrameImages frame = reference::makeSyntheticFrame();
    for (const float stops : {0.0f, 1.0f, -32.0f, 32.0f, 0.5f}) {
        Settings settings;
        settings.sampleCount = 4;
        settings.autoExposure = false;
        settings.exposureStops = stops;
        run(frame, settings);
        EXPECT_NEAR(double(pipeline_.exposure()) / std::exp2(double(stops)), 1.0, 1e-6) << stops;
    }

    // A black picture has no mean.
    reference::SyntheticOptions options;
    options.lightCount = 0;
    options.emission = false;
    Settings settings;
    settings.exposureStops = 2.0f;
    run(reference::makeSyntheticFrame(options), settings);
    EXPECT_NEAR(double(pipeline_.exposure()), 4.0, 4e-6);
}

TEST_P(Display, ToneCurvesGiveTheirBytes) {
    constexpr Extent kExtent{191, 7};
    reference::SyntheticOptions options;
    options.extent = kExtent;
    options.rsmSizePx = 2;
    const FrameImages frame = reference::makeSyntheticFrame(options);
    // From far below the smallest byte to far above white, denser than bytes, in another order a channel.
    HostImage radiance(PixelFormat::RGBA32F, kExtent);
    const int count = kExtent.widthPx * kExtent.heightPx;
    for (int i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            radiance.pixel(0, 0)[4 * i + c] = float(std::exp2(-14.0 + 18.0 * ((i * (c + 1)) % count) / count));
    // What is out of the ordinary.
    const float special[] = {
        0.0f,       -1.0f, 1.0f, 1e30f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        0.0031308f, 1e-38f};
    for (int i = 0; i < 8; ++i) radiance.pixel(0, 0)[4 * i] = special[i];

    for (const ToneCurve curve : {ToneCurve::Filmic, ToneCurve::Srgb}) {
        for (const float stops : {0.0f, -2.0f}) {
            Settings settings;
            settings.sampleCount = 1;
            settings.autoExposure = false;
            settings.toneCurve = curve;
            settings.exposureStops = stops;
            run(frame, settings);
            const HostImage display = pipeline_.toDisplay(radiance.view());
            ASSERT_EQ(display.format(), PixelFormat::RGBA8);
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(display.data());
            for (int i = 0; i < count; ++i) {
                for (int c = 0; c < 3; ++c) {
                    const float in = radiance.pixel(0, 0)[4 * i + c];
                    const double exposed = std::isfinite(in) ? double(in) * std::exp2(double(stops)) : 0.0;
                    // 1e-5: the error of 32 bits before the rounding to a byte; and the surface's.
                    const double error = 1e-5 + reference::surfaceRounding(GetParam());
                    const int least = reference::displayByte(exposed * (1.0 - error), curve == ToneCurve::Filmic);
                    const int most = reference::displayByte(exposed * (1.0 + error), curve == ToneCurve::Filmic);
                    ASSERT_GE(int(bytes[4 * i + c]), std::min(least, most)) << in << ", " << stops << " stops";
                    ASSERT_LE(int(bytes[4 * i + c]), std::max(least, most)) << in << ", " << stops << " stops";
                }
                ASSERT_EQ(bytes[4 * i + 3], 255);
            }
        }
    }

    // And the display is the picture through the same transform.
    Settings settings;
    settings.sampleCount = 8;
    run(frame, settings);
    const HostImage display = pipeline_.read(Output::Display), color = pipeline_.read(Output::Color);
    const HostImage again = pipeline_.toDisplay(color.view());
    EXPECT_EQ(std::memcmp(display.data(), again.data(), display.sizeBytes()), 0);
}

INSTANTIATE_TEST_SUITE_P(All, Display, testing::ValuesIn(reference::quickVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
