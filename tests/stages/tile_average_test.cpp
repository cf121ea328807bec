// The mean over a tile, alone: against its reference at every width and storage, on every device here, and what must
// hold of it whatever the picture.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/geometric.hpp>

#include "earthshine/error.hpp"
#include "interop/host_transport.hpp"
#include "pipeline/make_params.hpp"
#include "reference/device_variants.hpp"
#include "reference/frame_reference.hpp"
#include "reference/synthetic_frame.hpp"
#include "stages/frame_params.hpp"
#include "stages/tile_average_stage.hpp"
#include "support/surface_pixels.hpp"

namespace earthshine {
namespace {

/// What of a frame the stage sees.
struct Picture {
    Camera camera;
    HostImage normalWs, depth;
    Extent extent() const { return depth.extent(); }
};

/// A wall across the view; a pixel is `isBehind` or not on a second one 3 m behind it, or sky.
template <class IsSky, class IsBehind>
Picture walls(Extent extent, IsSky&& isSky, IsBehind&& isBehind) {
    reference::SyntheticOptions options;
    options.extent = extent;
    Picture p{reference::makeSyntheticFrame(options).camera, HostImage(PixelFormat::RGBA32F, extent),
              HostImage(PixelFormat::R32F, extent)};
    const glm::mat4 worldFromView = glm::inverse(p.camera.viewFromWorld);
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            if (isSky(x, y)) continue;
            *p.depth.pixel(x, y) = isBehind(x, y) ? 8.0f : 5.0f;
            for (int c = 0; c < 3; ++c) p.normalWs.pixel(x, y)[c] = worldFromView[2][c];
            p.normalWs.pixel(x, y)[3] = 1.0f;
        }
    }
    p.normalWs = toHalf(p.normalWs.view());
    return p;
}
bool nowhere(int, int) {
    return false;
}

/// Two walls so uneven that every decision goes both ways, and some sky.
Picture unevenWalls(Extent extent, bool isOrthographic) {
    std::mt19937 random(70);
    const auto uniform = [&random](double size) { return size * (double(random()) / 2147483648.0 - 1.0); };
    Picture p = walls(
        extent, [&](int x, int y) { return (x * 7 + y * 13) % 17 == 1; },
        [&](int x, int y) { return 2 * x > extent.widthPx + y; });
    if (isOrthographic) p.camera.clipFromView = glm::ortho(-4.0f, 5.0f, -1.5f, 1.0f, 0.1f, 30.0f);
    const glm::dmat3 worldFromView(glm::inverse(glm::dmat4(p.camera.viewFromWorld)));
    HostImage normal(PixelFormat::RGBA32F, extent);
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            const glm::dvec3 n = worldFromView * glm::normalize(glm::dvec3(uniform(0.4), uniform(0.4), 1.0));
            *p.depth.pixel(x, y) *= float(1.0 + uniform(0.02));
            if (*p.depth.pixel(x, y) == 0.0f) continue;
            for (int c = 0; c < 3; ++c) normal.pixel(x, y)[c] = float(n[c]);
            normal.pixel(x, y)[3] = 1.0f;
        }
    }
    p.normalWs = toHalf(normal.view());
    return p;
}

std::vector<glm::dvec3> randomIrradiance(Extent extent) {
    std::mt19937 random(3);
    std::vector<glm::dvec3> irradiance(std::size_t(extent.widthPx) * std::size_t(extent.heightPx));
    for (glm::dvec3& e : irradiance)
        for (int c = 0; c < 3; ++c) e[c] = double(random() % 2048) / 1024.0;
    return irradiance;
}

class TileAverage : public testing::TestWithParam<reference::Variant> {
protected:
    HostImage averaged(const Picture& p, const std::vector<glm::dvec3>& irradiance) {
        const Extent extent = p.extent();
        HostImage image(PixelFormat::RGBA32F, extent);
        for (std::size_t i = 0; i < irradiance.size(); ++i)
            for (int c = 0; c < 3; ++c) image.pixel(0, 0)[4 * i + std::size_t(c)] = float(irradiance[i][c]);
        const Surface normalWs(device_, PixelFormat::RGBA16F, extent), depth(device_, PixelFormat::R32F, extent);
        const Surface in(device_, PixelFormat::RGBA32F, extent), out(device_, PixelFormat::RGBA32F, extent);
        transport_.enqueueImage(p.normalWs.view(), normalWs, 0);
        transport_.enqueueImage(p.depth.view(), depth, 0);
        transport_.enqueueImage(image.view(), in, 0);
        FrameGeometry geometry;
        geometry.cameraRays = makeViewRays(p.camera, extent);
        geometry.extent = extent;
        stage_.enqueue({in, normalWs, depth, out}, makeParams(Settings(), geometry).tileAverage);
        HostImage result = test::readSurface(device_, out);
        transport_.release();
        return result;
    }

    Device device_{GetParam().caps, GetParam().options};
    HostTransport transport_{device_};
    TileAverageStage stage_{device_};
};

TEST_P(TileAverage, AgreesWithTheReference) {
    for (const Extent extent : {Extent{1, 1}, Extent{7, 3}, Extent{37, 11}, Extent{70, 9}}) {
        for (const bool isOrthographic : {false, true}) {
            SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx << ", " << isOrthographic);
            const Picture p = unevenWalls(extent, isOrthographic);
            const std::vector<glm::dvec3> irradiance = randomIrradiance(extent);
            const std::vector<reference::SurfacePoint> points =
                reference::surfacePoints(p.camera, p.normalWs.view(), p.depth.view());
            const reference::TileAverage expected = reference::tileAverage(p.camera, extent, points, irradiance);
            ASSERT_GT(expected.clearance, 5e-5);  // floats decide as doubles do: they are 1e-5 exact
            if (extent.widthPx > 7) {
                EXPECT_GT(expected.accepted, expected.taps / 5);
                EXPECT_LT(expected.accepted, expected.taps / 5 * 4);
            }
            const HostImage actual = averaged(p, irradiance);
            for (std::size_t i = 0; i < points.size(); ++i)
                for (int c = 0; c < 3; ++c)  // a sum of at most 16 floats of at most 2; surfaces round in and out
                    ASSERT_NEAR(double(actual.pixel(0, 0)[4 * i + std::size_t(c)]), expected.irradiance[i][c],
                                4e-6 + 4.0 * reference::surfaceRounding(GetParam()))
                        << int(i) % extent.widthPx << ", " << int(i) / extent.widthPx;
        }
    }
}

// What repeats every 4 x 4 pixels is gone wherever the window is whole: it holds every turn once.
TEST_P(TileAverage, APatternOfTheTilesPeriodBecomesItsMean) {
    const Extent extent{41, 13};
    const Picture p = walls(extent, nowhere, nowhere);
    std::vector<glm::dvec3> irradiance;
    for (int y = 0; y < extent.heightPx; ++y)
        for (int x = 0; x < extent.widthPx; ++x) irradiance.emplace_back(x % 4 + 4 * (y % 4), x % 4, y % 4);
    const HostImage actual = averaged(p, irradiance);
    for (int y = 1; y < extent.heightPx - 2; ++y) {
        for (int x = 1; x < extent.widthPx - 2; ++x) {
            ASSERT_EQ(actual.pixel(x, y)[0], 7.5f) << x << ", " << y;
            ASSERT_EQ(actual.pixel(x, y)[1], 1.5f) << x << ", " << y;
            ASSERT_EQ(actual.pixel(x, y)[2], 1.5f) << x << ", " << y;
        }
    }
}

// Two walls, one behind the other, and sky: each keeps its own light, to the rounding of a sum of 16.
TEST_P(TileAverage, AConstantStaysAndNothingBleeds) {
    const Extent extent{53, 17};
    const auto isSky = [](int x, int y) { return (x * 5 + y * 3) % 11 == 0; };
    const auto isBehind = [](int x, int y) { return (x / 5 + y / 3) % 2 == 1; };
    Picture p = walls(extent, isSky, isBehind);
    // The front wall so near that sky, taken for a point, would lie on it: depth alone says what is sky.
    p.camera.clipFromView = glm::ortho(-4.0f, 5.0f, -1.5f, 1.0f, 0.01f, 30.0f);
    for (int i = 0; i < extent.widthPx * extent.heightPx; ++i)
        if (float& depth = p.depth.pixel(0, 0)[i]; depth > 0.0f) depth -= 4.98f;
    p.normalWs = walls(extent, nowhere, isBehind).normalWs;
    std::vector<glm::dvec3> irradiance;
    for (int y = 0; y < extent.heightPx; ++y)
        for (int x = 0; x < extent.widthPx; ++x)
            irradiance.push_back(isSky(x, y)      ? glm::dvec3(1e6)
                                 : isBehind(x, y) ? glm::dvec3(1.1, 2.3, 3.7)
                                                  : glm::dvec3(700.0, 0.0, 0.13));
    const HostImage actual = averaged(p, irradiance);
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            const glm::dvec3& in = irradiance[std::size_t(y * extent.widthPx + x)];
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(double(actual.pixel(x, y)[c]), isSky(x, y) ? 0.0 : in[c],
                            (2e-6 + 2.0 * reference::surfaceRounding(GetParam())) * in[c] * !isSky(x, y))
                    << x << ", " << y;
        }
    }
}

TEST_P(TileAverage, OutputsAreFiniteWhateverThePictureHolds) {
    const Extent extent{37, 11};
    Picture p = walls(extent, nowhere, nowhere);
    std::mt19937 random(5);
    const auto one = [&random](auto... values) {
        const float all[] = {float(values)...};
        return all[random() % std::size(all)];
    };
    constexpr float kMax = std::numeric_limits<float>::max(), kLeast = std::numeric_limits<float>::denorm_min();
    HostImage normal(PixelFormat::RGBA32F, extent);
    std::vector<glm::dvec3> irradiance(std::size_t(extent.widthPx * extent.heightPx));
    for (int i = 0; i < extent.widthPx * extent.heightPx; ++i) {
        p.depth.pixel(0, 0)[i] = one(0, kLeast, 5, 5, 5, kMax);
        for (int c = 0; c < 3; ++c) normal.pixel(0, 0)[4 * i + c] = one(0, -1, 1, 1, 1, 65504, -65504);
        irradiance[std::size_t(i)] = glm::dvec3(0.9 * double(kMax));  // rounding may go up
    }
    p.normalWs = toHalf(normal.view());
    const HostImage actual = averaged(p, irradiance);
    for (int i = 0; i < 4 * extent.widthPx * extent.heightPx; ++i)
        ASSERT_NE(std::bit_cast<std::uint32_t>(actual.pixel(0, 0)[i]) & 0x7f800000u, 0x7f800000u) << i;
}

TEST_P(TileAverage, RefusesSurfacesOfOtherExtents) {
    const Surface right(device_, PixelFormat::RGBA32F, {8, 4}), wrong(device_, PixelFormat::RGBA32F, {8, 5});
    const Surface depth(device_, PixelFormat::R32F, {8, 4}), wrongDepth(device_, PixelFormat::R32F, {4, 4});
    EXPECT_THROW(stage_.enqueue({wrong, right, depth, right}, {}), DeviceError);
    EXPECT_THROW(stage_.enqueue({right, wrong, depth, right}, {}), DeviceError);
    EXPECT_THROW(stage_.enqueue({right, right, wrongDepth, right}, {}), DeviceError);
}

INSTANTIATE_TEST_SUITE_P(All, TileAverage, testing::ValuesIn(reference::allVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
