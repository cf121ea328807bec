// Irradiance is a property of the scene: it does not change with how it is sampled. All against the closed forms, 1 %.

#include <gtest/gtest.h>

#include <tuple>

#include <fmt/format.h>

#include "reference/device_variants.hpp"
#include "truth/truth_scene.hpp"

namespace earthshine::truth {
namespace {

constexpr double kBar = 0.01;
constexpr double kAlbedo = 0.5, kLux = 1000.0;
const Rectangle kEmitter{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
const Rectangle kAbove{{0, 1, -1}, {1, 0, 0}, {0, 0, 1}};
const Rectangle kBeside{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};

class Invariance : public testing::Test {
protected:
    static raster::Scene platesWith(const Rectangle& receiver) {
        raster::Scene scene;
        addRectangle(scene, kEmitter, kAlbedo);
        addRectangle(scene, receiver, 1.0);
        return scene;
    }
    double formFactor(const FrameImages& frame, const Settings& settings) {
        return meanOf(compute(pipeline_, frame, settings)) / (kAlbedo * kLux);
    }

    reference::Variant variant_ = reference::defaultVariants().at(0);
    Pipeline pipeline_{Device(variant_.caps, variant_.options)};
};

struct Map {
    int sizePx;
    double sideM;
};
// The emitter's edges lie on texels' edges with sides of 1 and 2 m. Elsewhere they are met to half a texel each: at
// worst 1 texel of a side of sizePx / sideM, 2 of it in area, so those maps are the finer ones.
constexpr Map kMaps[] = {{64, 1.0}, {128, 1.0}, {256, 2.0}, {1024, 1.0}, {512, 1.3}, {1024, 2.2}, {1024, 3.0}};

TEST_F(Invariance, SumOverMapSizeAndFrustum) {
    DrawnScene parallel(platesWith(kAbove)), perpendicular(platesWith(kBeside));
    for (const Map& map : kMaps) {
        const Light light = beamOnto(kEmitter, kLux, map.sideM);
        const std::string what = fmt::format("_{}px_{}m", map.sizePx, map.sideM);
        expectTruth("parallel" + what,
                    formFactor(parallel.draw(squareView(kAbove), {16, 16}, light, map.sizePx), fullSum()), 0.199825,
                    kBar);
        expectTruth("perpendicular" + what,
                    formFactor(perpendicular.draw(squareView(kBeside), {16, 16}, light, map.sizePx), fullSum()),
                    0.200044, kBar);
    }
}

TEST_F(Invariance, DiskOverSamplesRadiusMapSizeAndFrustum) {
    DrawnScene parallel(platesWith(kAbove));
    for (const Map& map : {Map{128, 1.0}, Map{512, 1.0}, Map{512, 1.3}}) {
        const FrameImages frame =
            parallel.draw(squareView(kAbove), {32, 32}, beamOnto(kEmitter, kLux, map.sideM), map.sizePx);
        const double sum = formFactor(frame, fullSum());
        // From sqrt(2) on the disk holds the map from any centre. Its samples share the area of the disk, 6 to 21 times
        // that of the emitter: 256 are some 12 to 40 on it.
        for (const double radiusUv : {1.4142136, 1.7, 2.0}) {
            for (const int sampleCount : {256, 1024, 4096}) {
                for (const Rotation rotation : {Rotation::Noise, Rotation::Off}) {
                    Settings settings = wholeDisk(sampleCount, radiusUv);
                    settings.rotation = rotation;
                    expectTruth(fmt::format("{}px_{}m_{}spp_radius_{}{}", map.sizePx, map.sideM, sampleCount, radiusUv,
                                            rotation == Rotation::Noise ? "" : "_fixed"),
                                formFactor(frame, settings), sum, kBar);
                }
            }
        }
    }
}

// Every pattern and density over radii has the mean of the full sum. A line needs the turns of many pixels.
TEST_F(Invariance, DiskOverPatternsAndMappings) {
    DrawnScene parallel(platesWith(kAbove));
    const FrameImages frame = parallel.draw(squareView(kAbove), {64, 64}, beamOnto(kEmitter, kLux, 1.3), 256);
    const double sum = formFactor(frame, fullSum());
    for (const DiskPattern pattern : {DiskPattern::Hammersley, DiskPattern::Line}) {
        for (const RadiusMapping mapping : {RadiusMapping::Area, RadiusMapping::Polar, RadiusMapping::Squared}) {
            for (const int sampleCount : {64, 256, 1024}) {
                for (const double radiusUv : {1.4142136, 2.0}) {
                    Settings settings = wholeDisk(sampleCount, radiusUv);
                    settings.pattern = pattern;
                    settings.mapping = mapping;
                    expectTruth(fmt::format("{}_{}_{}spp_radius_{}", kDiskPatternNames[int(pattern)],
                                            kRadiusMappingNames[int(mapping)], sampleCount, radiusUv),
                                formFactor(frame, settings), sum, kBar);
                }
            }
        }
    }
}

// The 16 turns of a tile, averaged, have the mean of the full sum: few samples, since 16 lines are 16 times as many;
// and at lower resolution. The mean lies half a pixel aside and is cut off at the picture's border, which costs up to a
// pixel's part of what the picture changes by: hence many pixels. All of them sample the same radii, so few samples
// miss the same part of a peak everywhere, until frames move them: hence eight frames.
TEST_F(Invariance, TileOverSamplesRadiusAndDivisor) {
    DrawnScene parallel(platesWith(kAbove)), perpendicular(platesWith(kBeside));
    const Extent extent{320, 320};
    const FrameImages above = parallel.draw(squareView(kAbove), extent, beamOnto(kEmitter, kLux, 1.0), 256);
    const FrameImages beside = perpendicular.draw(squareView(kBeside), extent, beamOnto(kEmitter, kLux, 1.0), 256);
    for (const int divisor : {1, 2}) {
        for (const int sampleCount : {16, 64, 256}) {
            for (const double radiusUv : {1.4142136, 2.0}) {
                Settings settings = wholeDisk(sampleCount, radiusUv);
                settings.pattern = DiskPattern::Line;
                settings.mapping = RadiusMapping::Squared;
                settings.rotation = Rotation::Tile;
                settings.divisor = divisor;
                settings.animatesNoise = true;
                const auto meanOfFrames = [&](const FrameImages& frame) {
                    double sum = 0.0;
                    for (int i = 0; i < 8; ++i) sum += formFactor(frame, settings) / 8.0;
                    return sum;
                };
                const std::string what = fmt::format("_1/{}_{}spp_radius_{}", divisor, sampleCount, radiusUv);
                expectTruth("parallel" + what, meanOfFrames(above), 0.199825, kBar);
                expectTruth("perpendicular" + what, meanOfFrames(beside), 0.200044, kBar);
            }
        }
    }
}

// Sets of pixels that share texels, around any of them: in parallel, where all of a picture is lit nearly alike, and
// along a shared edge, where a set has points near and far. 4096 samples of 320 pixels are more choices than a launch
// holds, so these come in bands of rows. Frames choose anew: eight of them.
TEST_F(Invariance, CoherentOverSamplesMappingsRadiusAndDivisor) {
    DrawnScene parallel(platesWith(kAbove)), perpendicular(platesWith(kBeside));
    const Extent extent{320, 320};
    const FrameImages above = parallel.draw(squareView(kAbove), extent, beamOnto(kEmitter, kLux, 1.0), 256);
    const FrameImages beside = perpendicular.draw(squareView(kBeside), extent, beamOnto(kEmitter, kLux, 1.0), 256);
    const auto check = [&](int sampleCount, RadiusMapping mapping, double radiusUv, int divisor, int frames) {
        Settings settings = wholeDisk(sampleCount, radiusUv);
        settings.rotation = Rotation::Coherent;
        settings.mapping = mapping;
        settings.divisor = divisor;
        settings.animatesNoise = true;
        const std::string what =
            fmt::format("_{}_1/{}_{}spp_radius_{}", kRadiusMappingNames[int(mapping)], divisor, sampleCount, radiusUv);
        for (const auto& [name, frame, truth] :
             {std::tuple("parallel", &above, 0.199825), {"perpendicular", &beside, 0.200044}}) {
            if (mapping == RadiusMapping::Area && sampleCount < 4096 && frame == &beside) continue;  // misses the peak
            double sum = 0.0;
            for (int i = 0; i < frames; ++i) sum += formFactor(*frame, settings) / frames;
            expectTruth(name + what, sum, truth, kBar);
        }
    };
    for (const RadiusMapping mapping : {RadiusMapping::Area, RadiusMapping::Polar, RadiusMapping::Squared})
        for (const int sampleCount : {8, 64}) check(sampleCount, mapping, 1.4142136, 1, 8);
    check(64, RadiusMapping::Squared, 2.0, 1, 8);
    check(64, RadiusMapping::Squared, 1.4142136, 2, 8);
    check(4096, RadiusMapping::Area, 1.4142136, 1, 1);
}

// Along a shared edge what a point receives peaks beside its own projection, at the pattern's centre: there the radii
// decide. Few pixels find the peak, so the mean is over many, and over extents that lay the noise's tile differently.
TEST_F(Invariance, DiskAlongASharedEdge) {
    DrawnScene perpendicular(platesWith(kBeside));
    for (const double radiusUv : {1.4142136, 2.0}) {
        for (const int sampleCount : {256, 1024, 4096}) {
            double sum = 0.0;
            int count = 0;
            const int step = sampleCount == 4096 ? 17 : 5;  // more samples need fewer pixels
            for (int side = 67; side <= 135; side += step, ++count)
                sum += formFactor(
                    perpendicular.draw(squareView(kBeside), {side, side}, beamOnto(kEmitter, kLux, 1.0), 256),
                    wholeDisk(sampleCount, radiusUv));
            expectTruth(fmt::format("{}spp_radius_{}", sampleCount, radiusUv), sum / count, 0.200044, kBar);
        }
    }
}

}  // namespace
}  // namespace earthshine::truth
