// Every stage against its reference in doubles, at every width and storage, on every device here.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "earthshine/error.hpp"
#include "earthshine/pipeline.hpp"
#include "image/temp_folder.hpp"
#include "reference/device_variants.hpp"
#include "reference/frame_reference.hpp"
#include "reference/synthetic_frame.hpp"

namespace earthshine {
namespace {

using reference::SurfacePoint;
using reference::Vpl;

bool gathersFromRecords(const reference::Variant& variant) {
    return variant.options.rsmRecords != 0;
}

class FrameStages : public testing::TestWithParam<reference::Variant> {};

// Float arithmetic over a few hundred terms, and a record's normal of 16 bits and radius of 11 bits: 2e-3 of a value,
// or of the frame's mean where a value is a difference of large terms.
constexpr double kRelative = 2e-3;

void expectClose(const HostImage& actual, const std::vector<glm::dvec3>& expected,
                 const std::vector<SurfacePoint>& points, double relative) {
    double mean = 0.0;
    for (const glm::dvec3& e : expected) mean += (e.x + e.y + e.z) / 3.0 / double(expected.size());
    ASSERT_GT(mean, 0.0);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const int x = int(i) % actual.extent().widthPx, y = int(i) / actual.extent().widthPx;
        const float* a = actual.pixel(x, y);
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(a[c], expected[i][c], relative * (std::fabs(expected[i][c]) + mean))
                << x << ", " << y << ": channel " << c;
        ASSERT_EQ(a[3], points[i].isValid ? 1.0f : 0.0f) << x << ", " << y;
    }
}

struct Expected {
    std::vector<SurfacePoint> points;
    std::vector<glm::dvec3> direct, sum, disk;
};

reference::DiskShape shapeOf(const Settings& settings) {
    constexpr double kPowers[] = {0.5, 1.0, 2.0};
    return {settings.pattern == DiskPattern::Line, kPowers[int(settings.mapping)]};
}

Expected expectedOf(const FrameImages& images, const Settings& settings, int frameIndex) {
    const FrameInputs frame = images.inputs();
    Expected e;
    e.points = reference::surfacePoints(frame.camera, frame.gbuffer.normalWs, frame.gbuffer.depth);
    e.direct.resize(e.points.size());
    e.sum.resize(e.points.size());
    e.disk.resize(e.points.size());
    const int width = frame.gbuffer.depth.extent.widthPx;
    const reference::PatternMove step =
        reference::frameMove(settings.animatesNoise ? frameIndex : 0, settings.sampleCount);
    const auto moveOf = [&](int x, int y) {
        const reference::PatternMove move = settings.rotation == Rotation::Noise ? reference::patternMove(x, y)
                                            : settings.rotation == Rotation::Tile
                                                ? reference::tileMove(x, y, settings.sampleCount)
                                                : reference::PatternMove{0.5 / settings.sampleCount, 0.0};
        return reference::PatternMove{move.shift + step.shift, move.turn + step.turn};
    };
    for (std::size_t l = 0; l < frame.lights.size(); ++l) {
        std::vector<Vpl> texels = reference::vpls(frame.lights[l], frame.lightMaps[l]);
        int size = frame.lightMaps[l].rsmDepth.extent.widthPx;
        double mapScale = 1.0;
        const auto indirectScale = double(frame.lights[l].indirectScale);
        const float own = frame.lights[l].gatherRadiusUv;
        const auto radiusUv = double(own > 0.0f ? own : settings.radiusUv);
        if (const int factor = settings.rsmMinify; factor > 1) {
            // Frames pick other texels, but for the full sum, which is the same in all.
            const bool picksAnew = settings.animatesNoise && settings.estimator == Estimator::Disk;
            texels = reference::minified(texels, size, factor, int(l), std::uint32_t(picksAnew ? frameIndex : 0));
            const int blocks = (size + factor - 1) / factor;
            mapScale = double(size) / (blocks * factor);
            size = blocks;
        }
        for (std::size_t i = 0; i < e.points.size(); ++i) {
            e.direct[i] +=
                reference::directLight(e.points[i], frame.lights[l], frame.lightMaps[l].shadowDepth,
                                       double(settings.shadowBiasTexels), double(settings.shadowSlopeBiasTexels));
            e.sum[i] += indirectScale * reference::rsmSum(e.points[i], texels);
            e.disk[i] += indirectScale *
                         reference::rsmDisk(e.points[i], texels, frame.lights[l], size, settings.sampleCount, radiusUv,
                                            moveOf(int(i) % width, int(i) / width), mapScale, shapeOf(settings));
        }
    }
    return e;
}

TEST_P(FrameStages, AgreeWithTheReference) {
    Pipeline pipeline{Device(GetParam().caps, GetParam().options)};
    int frameIndex = 0;  // a pipeline counts its runs
    for (const Extent extent : {Extent{1, 1}, Extent{37, 11}, Extent{7, 3}}) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        reference::SyntheticOptions options;
        options.extent = extent;
        if (extent.widthPx == 1) options.skyFraction = 0.0;
        const FrameImages images = reference::makeSyntheticFrame(options);
        Settings settings;
        settings.sampleCount = 13;
        settings.radiusUv = 0.4f;
        settings.rotation = extent.widthPx != 7 ? Rotation::Noise : Rotation::Off;
        settings.animatesNoise = extent.widthPx != 1;
        const Expected expected = expectedOf(images, settings, frameIndex);
        pipeline.setFrame(images.inputs());

        pipeline.run(settings);
        expectClose(pipeline.read(Output::DirectIrradiance), expected.direct, expected.points, kRelative);
        expectClose(pipeline.read(Output::IndirectIrradiance), expected.disk, expected.points, kRelative);

        settings.estimator = Estimator::Sum;
        pipeline.run(settings);
        frameIndex += 2;
        expectClose(pipeline.read(Output::IndirectIrradiance), expected.sum, expected.points, kRelative);
    }
}

TEST_P(FrameStages, AgreeWithTheReferenceOfEveryDisk) {
    Pipeline pipeline{Device(GetParam().caps, GetParam().options)};
    const FrameImages images = reference::makeSyntheticFrame();
    pipeline.setFrame(images.inputs());
    int frameIndex = 0;
    for (const DiskPattern pattern : {DiskPattern::Hammersley, DiskPattern::Line}) {
        for (const RadiusMapping mapping : {RadiusMapping::Area, RadiusMapping::Polar, RadiusMapping::Squared}) {
            SCOPED_TRACE(testing::Message() << int(pattern) << ", " << int(mapping));
            Settings settings;
            settings.sampleCount = 13;
            settings.radiusUv = 0.7f;
            settings.pattern = pattern;
            settings.mapping = mapping;
            const Expected expected = expectedOf(images, settings, frameIndex++);
            pipeline.run(settings);
            expectClose(pipeline.read(Output::IndirectIrradiance), expected.disk, expected.points, kRelative);
        }
    }
}

// On random surfaces, where next to nothing is averaged, and on a wall across the view, where all of a tile is.
TEST_P(FrameStages, AgreeWithTheReferenceOfTheTile) {
    Pipeline pipeline{Device(GetParam().caps, GetParam().options)};
    int frameIndex = 0;
    for (const Extent extent : {Extent{37, 11}, Extent{7, 3}}) {
        for (const bool isWall : {false, true}) {
            SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx << ", wall " << isWall);
            reference::SyntheticOptions options;
            options.extent = extent;
            FrameImages images = reference::makeSyntheticFrame(options);
            if (isWall) {
                const glm::mat4 worldFromView = glm::inverse(images.camera.viewFromWorld);
                HostImage normal(PixelFormat::RGBA32F, extent);
                for (int i = 0; i < extent.widthPx * extent.heightPx; ++i) {
                    float& depth = images.depth.pixel(0, 0)[i];
                    if (depth > 0.0f) depth = 5.0f;
                    for (int c = 0; c < 4; ++c) normal.pixel(0, 0)[4 * i + c] = c < 3 ? worldFromView[2][c] : 1.0f;
                }
                images.normalWs = toHalf(normal.view());
            }
            pipeline.setFrame(images.inputs());
            for (const DiskPattern pattern : {DiskPattern::Hammersley, DiskPattern::Line}) {
                Settings settings;
                settings.sampleCount = 5;
                settings.radiusUv = 0.7f;
                settings.pattern = pattern;
                settings.mapping = RadiusMapping::Squared;
                settings.rotation = Rotation::Tile;
                Expected expected = expectedOf(images, settings, frameIndex++);
                const reference::TileAverage average =
                    reference::tileAverage(images.camera, extent, expected.points, expected.disk);
                ASSERT_GT(average.clearance, 1e-4);  // floats decide as doubles do
                EXPECT_EQ(average.accepted == average.taps, isWall);
                pipeline.run(settings);
                expectClose(pipeline.read(Output::IndirectIrradiance), average.irradiance, expected.points, kRelative);
            }
        }
    }
}

// A map of 13 texels a side: every factor leaves blocks at the border with fewer texels.
TEST_P(FrameStages, AgreeWithTheReferenceOfMinifiedMaps) {
    Pipeline pipeline{Device(GetParam().caps, GetParam().options)};
    reference::SyntheticOptions options;
    options.rsmSizePx = 13;
    const FrameImages images = reference::makeSyntheticFrame(options);
    pipeline.setFrame(images.inputs());
    Settings settings;
    settings.sampleCount = 13;
    settings.radiusUv = 0.4f;
    if (!gathersFromRecords(GetParam())) {
        settings.rsmMinify = 2;
        EXPECT_THAT(test::thrown<UsageError>([&] { pipeline.run(settings); }), testing::StartsWith("rsm-minify: 2 "));
        return;
    }
    int frameIndex = 0;
    for (const int factor : {2, 4, 8}) {
        SCOPED_TRACE(factor);
        settings.rsmMinify = factor;
        for (const Estimator estimator : {Estimator::Disk, Estimator::Sum}) {
            settings.estimator = estimator;
            const Expected expected = expectedOf(images, settings, frameIndex++);
            pipeline.run(settings);
            expectClose(pipeline.read(Output::IndirectIrradiance),
                        estimator == Estimator::Disk ? expected.disk : expected.sum, expected.points, kRelative);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, FrameStages, testing::ValuesIn(reference::allVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
