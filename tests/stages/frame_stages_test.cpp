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
            if (settings.rotation == Rotation::Coherent) continue;
            e.disk[i] += indirectScale *
                         reference::rsmDisk(e.points[i], texels, frame.lights[l], size, settings.sampleCount, radiusUv,
                                            moveOf(int(i) % width, int(i) / width), mapScale, shapeOf(settings));
        }
        if (settings.rotation != Rotation::Coherent) continue;
        const std::vector<glm::dvec3> light = reference::rsmCoherent(
            e.points, frame.gbuffer.depth.extent, texels, frame.lights[l], size, settings.sampleCount, radiusUv,
            settings.animatesNoise ? frameIndex : 0, mapScale, shapeOf(settings));
        for (std::size_t i = 0; i < light.size(); ++i) e.disk[i] += indirectScale * light[i];
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

// Widths of a part of a span, of one and a pixel more, and of more than two; sets all of sky, some, none. Two maps of a
// spot and one of a sun; each light its own radius.
TEST_P(FrameStages, AgreeWithTheReferenceOfCoherentSets) {
    Pipeline pipeline{Device(GetParam().caps, GetParam().options)};
    int frameIndex = 0;
    for (const Extent extent : {Extent{1, 1}, Extent{7, 3}, Extent{65, 4}, Extent{150, 3}}) {
        for (const double skyFraction : {0.0, 0.2, 0.9}) {
            SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx << ", sky " << skyFraction);
            if (extent.widthPx == 1 && skyFraction > 0.0) continue;
            reference::SyntheticOptions options;
            options.extent = extent;
            options.skyFraction = skyFraction;
            const FrameImages images = reference::makeSyntheticFrame(options);
            pipeline.setFrame(images.inputs());
            for (const RadiusMapping mapping : {RadiusMapping::Area, RadiusMapping::Polar, RadiusMapping::Squared}) {
                Settings settings;
                settings.sampleCount = extent.widthPx == 1 ? 97 : 13;
                settings.radiusUv = mapping == RadiusMapping::Polar ? 0.4f : 1.4143f;
                settings.mapping = mapping;
                settings.pattern = skyFraction == 0.2 ? DiskPattern::Line : DiskPattern::Hammersley;
                settings.rotation = Rotation::Coherent;
                settings.animatesNoise = mapping != RadiusMapping::Area;
                settings.rsmMinify = gathersFromRecords(GetParam()) && mapping == RadiusMapping::Squared ? 2 : 1;
                const Expected expected = expectedOf(images, settings, frameIndex++);
                pipeline.run(settings);
                expectClose(pipeline.read(Output::IndirectIrradiance), expected.disk, expected.points, kRelative);
            }
        }
    }
}

// Whatever the disks, frames' mean tends to the full sum at every pixel. In doubles, 32 000 frames of 8 samples, on a
// scene of chance whose light is mostly a few peaks: 125 frames are off by 0.5 to 1 of the mean, these by 0.01 to 0.03,
// all of the picture by 0.24 % at most; no more than twice that is asked for.
TEST(CoherentReference, FramesTendToTheFullSum) {
    reference::SyntheticOptions options;
    options.extent = {68, 2};
    options.lightCount = 2;
    const FrameImages images = reference::makeSyntheticFrame(options);
    const FrameInputs frame = images.inputs();
    const std::vector<SurfacePoint> points =
        reference::surfacePoints(frame.camera, frame.gbuffer.normalWs, frame.gbuffer.depth);
    for (std::size_t l = 0; l < frame.lights.size(); ++l) {
        const std::vector<Vpl> texels = reference::vpls(frame.lights[l], frame.lightMaps[l]);
        const int size = frame.lightMaps[l].rsmDepth.extent.widthPx;
        for (const double power : {0.5, 1.0, 2.0}) {
            SCOPED_TRACE(testing::Message() << "light " << l << ", power " << power);
            constexpr int kFrames = 32000;
            std::vector<double> mean(points.size(), 0.0);
            for (int i = 0; i < kFrames; ++i) {
                const std::vector<glm::dvec3> one = reference::rsmCoherent(
                    points, options.extent, texels, frame.lights[l], size, 8, 1.4143, i, 1.0, {false, power});
                for (std::size_t k = 0; k < one.size(); ++k) mean[k] += one[k].y / kFrames;
            }
            double total = 0.0, totalSum = 0.0, squares = 0.0;
            for (std::size_t k = 0; k < mean.size(); ++k) {
                const double sum = reference::rsmSum(points[k], texels).y;
                total += mean[k];
                totalSum += sum;
                squares += (mean[k] - sum) * (mean[k] - sum);
            }
            EXPECT_NEAR(total / totalSum, 1.0, 0.005);
            EXPECT_LT(std::sqrt(squares * double(points.size())) / totalSum, 0.06);
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
