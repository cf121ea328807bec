// Lower resolution and back: picking, upsampling and interpolating against their references, at every width and
// storage, on every device here; and what must hold of them whatever the picture.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <random>

#include "earthshine/error.hpp"
#include "interop/host_transport.hpp"
#include "pipeline/make_params.hpp"
#include "reference/device_variants.hpp"
#include "reference/lower_resolution.hpp"
#include "reference/synthetic_frame.hpp"
#include "stages/bilateral_upsample_stage.hpp"
#include "stages/blue_noise.hpp"
#include "stages/downsample_stage.hpp"
#include "stages/frame_params.hpp"
#include "stages/interpolate_stage.hpp"
#include "stages/pick_grid.hpp"
#include "stages/rsm_gather_list_stage.hpp"
#include "stages/rsm_pack_stage.hpp"
#include "support/surface_pixels.hpp"

namespace earthshine {
namespace {

using reference::Answer;
using reference::Picks;
using reference::Still;

constexpr int kStrides[] = {1, 2, 4};

// Weights of float arithmetic, near 1 in sum; planes' distances lose some digits (kClear of the reference): of
// irradiance of at most 2, 1e-4 where a weight is steep in the distance.
constexpr double kNear = 2e-4;

std::vector<glm::dvec3> randomIrradiance(Extent extent) {
    std::mt19937 random(3);
    std::vector<glm::dvec3> irradiance(std::size_t(extent.widthPx) * std::size_t(extent.heightPx));
    for (glm::dvec3& e : irradiance)
        for (int c = 0; c < 3; ++c) e[c] = double(random() % 2048) / 1024.0;
    return irradiance;
}

HostImage imageOf(Extent extent, const std::vector<glm::dvec3>& values) {
    HostImage image(PixelFormat::RGBA32F, extent);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int c = 0; c < 3; ++c) image.pixel(0, 0)[4 * i + std::size_t(c)] = float(values[i][int(c)]);
    return image;
}

bool isFinite(float v) {
    return (std::bit_cast<std::uint32_t>(v) & 0x7f800000u) != 0x7f800000u;
}

/// One picture on the device, at full and at lower resolution.
struct Picture {
    Picture(const Device& device, HostTransport& transport, DownsampleStage& downsample, const Still& still, int s)
        : stride(s),
          extent(still.depth.extent()),
          low(pickedExtent(extent, s)),
          rays(makeViewRays(still.camera, extent)),
          normalWs(device, PixelFormat::RGBA16F, extent),
          depth(device, PixelFormat::R32F, extent),
          motion(device, PixelFormat::RGBA16F, extent),
          lowNormalWs(device, PixelFormat::RGBA16F, low),
          lowDepth(device, PixelFormat::R32F, low),
          lowMotion(device, PixelFormat::RGBA16F, low),
          lowIrradiance(device, PixelFormat::RGBA32F, low),
          irradiance(device, PixelFormat::RGBA32F, extent),
          pixels(device.impl().makeBuffer(sizeof(i32) * std::size_t(extent.widthPx * extent.heightPx))),
          count(device.impl().makeBuffer(sizeof(i32))) {
        transport.enqueueImage(still.normalWs.view(), normalWs, 0);
        transport.enqueueImage(still.depth.view(), depth, 0);
        transport.enqueueImage(still.motion.view(), motion, 0);
        downsample.enqueue({normalWs, depth, &motion, lowNormalWs, lowDepth, &lowMotion}, stride);
        device.impl().queue.finish();
        transport.release();
    }

    int stride;
    Extent extent, low;
    ViewRays rays;
    Surface normalWs, depth, motion, lowNormalWs, lowDepth, lowMotion, lowIrradiance, irradiance;
    cl::Buffer pixels, count;
};

class LowerResolution : public testing::TestWithParam<reference::Variant> {
protected:
    Picture picture(const Still& still, int stride) { return {device_, transport_, downsample_, still, stride}; }

    HostImage upsampled(Picture& p, const std::vector<glm::dvec3>& low) {
        const HostImage image = imageOf(p.low, low);
        transport_.enqueueImage(image.view(), p.lowIrradiance, 0);
        if (!upsample_) upsample_.emplace(device_);
        upsample_->enqueue({p.normalWs, p.depth, p.lowNormalWs, p.lowDepth, p.lowIrradiance, p.irradiance}, p.rays,
                           p.stride);
        HostImage result = test::readSurface(device_, p.irradiance);
        transport_.release();
        return result;
    }

    struct Interpolated {
        HostImage irradiance;
        std::vector<i32> listed;  ///< sorted
    };
    Interpolated interpolated(Picture& p, const std::vector<glm::dvec3>& low, const Suitability& suitability) {
        const HostImage image = imageOf(p.low, low);
        transport_.enqueueImage(image.view(), p.lowIrradiance, 0);
        if (!interpolate_) interpolate_.emplace(device_);
        interpolate_->enqueue(
            {p.normalWs, p.depth, p.lowNormalWs, p.lowDepth, p.lowIrradiance, p.irradiance, p.pixels, p.count}, p.rays,
            p.stride, suitability);
        Interpolated result{test::readSurface(device_, p.irradiance), {}};
        transport_.release();
        i32 count = -1;
        device_.impl().queue.enqueueReadBuffer(p.count, CL_TRUE, 0, sizeof count, &count);
        EXPECT_GE(count, 0);
        EXPECT_LE(count, p.extent.widthPx * p.extent.heightPx);
        result.listed.resize(std::size_t(count));
        if (count > 0)
            device_.impl().queue.enqueueReadBuffer(p.pixels, CL_TRUE, 0, sizeof(i32) * std::size_t(count),
                                                   result.listed.data());
        std::sort(result.listed.begin(), result.listed.end());
        return result;
    }

    Device device_{GetParam().caps, GetParam().options};
    HostTransport transport_{device_};
    DownsampleStage downsample_{device_};
    std::optional<BilateralUpsampleStage> upsample_;
    std::optional<InterpolateStage> interpolate_;
};

// Every picture of the agreement tests: one pixel, fewer than a texel, one more than a few lanes, and one with room for
// edges of every kind.
struct Case {
    Extent extent;
    bool isOrthographic;
};
constexpr Case kCases[] = {{{1, 1}, false}, {{7, 3}, false}, {{37, 11}, true}, {{37, 11}, false}, {{191, 347}, false}};

TEST_P(LowerResolution, PicksPixelsAndTheirRays) {
    for (const Case& c : kCases) {
        const Still still = reference::makeStill(c.extent, c.isOrthographic);
        const HostImage normal = toFloat(still.normalWs.view()), motion = toFloat(still.motion.view());
        for (const int stride : kStrides) {
            SCOPED_TRACE(testing::Message() << c.extent.widthPx << " x " << c.extent.heightPx << " / " << stride);
            const Picks picks(c.extent, stride);
            const Picture p = picture(still, stride);
            ASSERT_EQ(p.low, picks.low);
            const HostImage lowNormal = test::readSurface(device_, p.lowNormalWs);
            const HostImage lowDepth = test::readSurface(device_, p.lowDepth);
            const HostImage lowMotion = test::readSurface(device_, p.lowMotion);
            const ViewRays rays = pickedRays(p.rays, makePickGrid(c.extent, stride));
            for (int y = 0; y < p.low.heightPx; ++y) {
                for (int x = 0; x < p.low.widthPx; ++x) {
                    const int fullX = picks.x(x), fullY = picks.y(y);
                    ASSERT_LT(fullX, c.extent.widthPx);
                    ASSERT_LT(fullY, c.extent.heightPx);
                    ASSERT_EQ(*lowDepth.pixel(x, y), *still.depth.pixel(fullX, fullY)) << x << ", " << y;
                    for (int i = 0; i < 3; ++i) {
                        ASSERT_EQ(lowNormal.pixel(x, y)[i], normal.pixel(fullX, fullY)[i]) << x << ", " << y;
                        ASSERT_EQ(lowMotion.pixel(x, y)[i], motion.pixel(fullX, fullY)[i] / float(i < 2 ? stride : 1))
                            << x << ", " << y;
                    }
                    const double depth = 3.0;
                    const glm::dvec3 expected = reference::unproject(
                        still.camera, {(fullX + 0.5) / c.extent.widthPx, (fullY + 0.5) / c.extent.heightPx}, depth);
                    const auto along = [&](const f32x4& a, const f32x4& dx, const f32x4& dy) {
                        return glm::dvec3(a.x, a.y, a.z) + double(x) * glm::dvec3(dx.x, dx.y, dx.z) +
                               double(y) * glm::dvec3(dy.x, dy.y, dy.z);
                    };
                    const glm::dvec3 actual = along(rays.origin, rays.originDx, rays.originDy) +
                                              depth * along(rays.ray, rays.rayDx, rays.rayDy);
                    // Floats of steps a pixel, some hundred times: 1e-7 of metres each.
                    ASSERT_LT(glm::length(actual - expected), 1e-5) << x << ", " << y;
                }
            }
        }
    }
}

TEST_P(LowerResolution, UpsamplingAgreesWithTheReference) {
    for (const Case& c : kCases) {
        const Still still = reference::makeStill(c.extent, c.isOrthographic);
        const auto points = reference::surfacePoints(still.camera, still.normalWs.view(), still.depth.view());
        for (const int stride : kStrides) {
            SCOPED_TRACE(testing::Message() << c.extent.widthPx << " x " << c.extent.heightPx << " / " << stride);
            const Picks picks(c.extent, stride);
            const std::vector<glm::dvec3> low = randomIrradiance(picks.low);
            const std::vector<Answer> expected = reference::upsample(still.camera, points, still.depth, picks, low);
            Picture p = picture(still, stride);
            const HostImage actual = upsampled(p, low);
            int clear = 0, lost = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const float* a = actual.pixel(0, 0) + 4 * i;
                lost += expected[i].isLost ? 1 : 0;
                for (int channel = 0; channel < 3; ++channel) {
                    ASSERT_GE(a[channel], 0.0f);
                    ASSERT_LE(a[channel], 2.0f);
                    if (expected[i].isClear) {
                        ASSERT_NEAR(a[channel], expected[i].irradiance[channel], kNear)
                            << i % std::size_t(c.extent.widthPx) << ", " << i / std::size_t(c.extent.widthPx);
                    }
                }
                clear += expected[i].isClear ? 1 : 0;
            }
            EXPECT_GE(clear, int(0.97 * double(expected.size())));
            if (c.extent.widthPx > 100 && stride > 1) {
                EXPECT_GT(lost, 100);
            }
        }
    }
}

TEST_P(LowerResolution, InterpolationAgreesWithTheReference) {
    for (const Case& c : kCases) {
        const Still still = reference::makeStill(c.extent, c.isOrthographic);
        const auto points = reference::surfacePoints(still.camera, still.normalWs.view(), still.depth.view());
        for (const int stride : kStrides) {
            SCOPED_TRACE(testing::Message() << c.extent.widthPx << " x " << c.extent.heightPx << " / " << stride);
            const Picks picks(c.extent, stride);
            const std::vector<glm::dvec3> low = randomIrradiance(picks.low);
            const Suitability suitability{0.95f, 0.7f};
            const std::vector<Answer> expected =
                reference::interpolate(still.camera, points, still.depth, picks, low, double(suitability.minCosine),
                                       double(suitability.maxPlaneTexels));
            Picture p = picture(still, stride);
            const Interpolated actual = interpolated(p, low, suitability);
            ASSERT_EQ(std::adjacent_find(actual.listed.begin(), actual.listed.end()), actual.listed.end())
                << "a pixel twice";
            int clear = 0, listed = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const float* a = actual.irradiance.pixel(0, 0) + 4 * i;
                const bool isListed = std::binary_search(actual.listed.begin(), actual.listed.end(), i32(i));
                for (int channel = 0; channel < 3; ++channel) {
                    ASSERT_TRUE(isFinite(a[channel]));
                    if (isListed || !points[i].isValid) {
                        ASSERT_EQ(a[channel], 0.0f);
                    }
                }
                if (!expected[i].isClear) continue;
                ++clear;
                listed += isListed ? 1 : 0;
                ASSERT_EQ(isListed, expected[i].isListed)
                    << i % std::size_t(c.extent.widthPx) << ", " << i / std::size_t(c.extent.widthPx);
                for (int channel = 0; channel < 3; ++channel)
                    ASSERT_NEAR(a[channel], expected[i].irradiance[channel], kNear);
            }
            EXPECT_GE(clear, int(0.97 * double(expected.size())));
            if (stride == 1) {
                EXPECT_EQ(actual.listed.size(), 0u);  // every pixel was picked
            } else if (c.extent.widthPx > 100) {
                EXPECT_GT(listed, 100);
                EXPECT_LT(listed, int(expected.size() / 4));
            }
        }
    }
}

// A floor that runs away from the camera, and above it, nearer than the floor behind it, a board; sky beyond.
Still floorAndBoard(Extent extent) {
    Still still = reference::makeStill(extent, false);
    HostImage normal(PixelFormat::RGBA32F, extent);
    const glm::dmat4 worldFromView = glm::inverse(glm::dmat4(still.camera.viewFromWorld));
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            const glm::dvec2 uv((x + 0.5) / extent.widthPx, (y + 0.5) / extent.heightPx);
            const glm::dvec3 one = reference::unproject(still.camera, uv, 1.0);
            const glm::dvec3 direction = reference::unproject(still.camera, uv, 2.0) - one;
            const double floorDepth = 1.0 - one.y / direction.y;
            const bool isBoard = x >= extent.widthPx / 2;
            const bool isFloor = floorDepth > 1.0 && floorDepth < 40.0;
            *still.depth.pixel(x, y) = isBoard ? 1.5f : isFloor ? float(floorDepth) : 0.0f;
            const glm::dvec3 n = isBoard ? glm::dvec3(worldFromView[2]) : glm::dvec3(0, 1, 0);
            for (int c = 0; c < 3; ++c) normal.pixel(x, y)[c] = float(n[c]);
        }
    }
    still.normalWs = toHalf(normal.view());
    return still;
}

TEST_P(LowerResolution, AConstantStaysAndNothingBleeds) {
    constexpr Extent kExtent{70, 41};
    const Still still = floorAndBoard(kExtent);
    for (const int stride : kStrides) {
        SCOPED_TRACE(stride);
        const Picks picks(kExtent, stride);
        Picture p = picture(still, stride);
        // 1.1 everywhere: whatever the weights, it comes out as 1.1, to the rounding of two sums and a division.
        // Then 1 on the floor and 100 on the board: each keeps its own, also where the board's plane meets the floor,
        // as the cosine between them is 0.1, and its 8th power 1e-8 of 100.
        std::vector<glm::dvec3> constant(randomIrradiance(picks.low).size(), glm::dvec3(1.1)), two = constant;
        for (int y = 0; y < picks.low.heightPx; ++y)
            for (int x = 0; x < picks.low.widthPx; ++x)
                two[std::size_t(y * picks.low.widthPx + x)] =
                    glm::dvec3(picks.x(x) >= kExtent.widthPx / 2 ? 100.0 : 1.0);
        const HostImage flat = upsampled(p, constant), apart = upsampled(p, two);
        const Interpolated flatToo = interpolated(p, constant, {}), apartToo = interpolated(p, two, {});
        int sky = 0, interpolatedPixels = 0;
        const double rounding = 2.0 * reference::surfaceRounding(GetParam());  // in and out
        for (int y = 0; y < kExtent.heightPx; ++y) {
            for (int x = 0; x < kExtent.widthPx; ++x) {
                SCOPED_TRACE(testing::Message() << x << ", " << y);
                const bool isBoard = x >= kExtent.widthPx / 2, isSky = *still.depth.pixel(x, y) == 0.0f;
                sky += isSky ? 1 : 0;
                ASSERT_NEAR(flat.pixel(x, y)[1], isSky ? 0.0 : 1.1, 5e-7 + 1.1 * rounding);
                ASSERT_NEAR(apart.pixel(x, y)[1], isSky ? 0.0 : isBoard ? 100.0 : 1.0, isBoard ? 5e-5 : 3e-6);
                const i32 index = y * kExtent.widthPx + x;
                if (std::binary_search(flatToo.listed.begin(), flatToo.listed.end(), index)) continue;
                ++interpolatedPixels;
                ASSERT_NEAR(flatToo.irradiance.pixel(x, y)[1], isSky ? 0.0 : 1.1, 5e-7 + 1.1 * rounding);
                ASSERT_NEAR(apartToo.irradiance.pixel(x, y)[1],
                            isSky     ? 0.0
                            : isBoard ? 100.0
                                      : 1.0,
                            isBoard ? 5e-5 : 5e-7);
            }
        }
        EXPECT_GT(sky, 200);
        EXPECT_GT(interpolatedPixels, 2000);
        EXPECT_EQ(flatToo.listed, apartToo.listed);
    }
}

TEST_P(LowerResolution, WhatIsLinearOnAPlaneStaysLinear) {
    constexpr Extent kExtent{70, 41};
    const Still still = floorAndBoard(kExtent);
    const auto light = [](int x, int y) { return glm::dvec3(1.0 + 0.03 * x, 2.0 - 0.02 * y, 0.01 * x + 0.02 * y); };
    for (const int stride : kStrides) {
        SCOPED_TRACE(stride);
        const Picks picks(kExtent, stride);
        Picture p = picture(still, stride);
        std::vector<glm::dvec3> low;
        for (int y = 0; y < picks.low.heightPx; ++y)
            for (int x = 0; x < picks.low.widthPx; ++x) low.push_back(light(picks.x(x), picks.y(y)));
        const HostImage up = upsampled(p, low);
        const Interpolated in = interpolated(p, low, {});
        // The board, away from its edge and from the picture's, beyond whose outermost texels light is constant.
        for (int y = stride; y < kExtent.heightPx - stride; ++y) {
            for (int x = kExtent.widthPx / 2 + stride; x < kExtent.widthPx - stride; ++x) {
                for (int c = 0; c < 3; ++c) {
                    // Lit to 3; its normal in half is off by 3e-4, which bends weights by as little. Surfaces round
                    // in and out.
                    const double error = 1e-5 + 3.0 * 2.0 * reference::surfaceRounding(GetParam());
                    ASSERT_NEAR(up.pixel(x, y)[c], light(x, y)[c], error) << x << ", " << y;
                    ASSERT_NEAR(in.irradiance.pixel(x, y)[c], light(x, y)[c], error) << x << ", " << y;
                }
            }
        }
    }
}

// Every bit pattern that a picture can hold comes in through unpack, which lets finite numbers through: none of them
// may become a NaN or an infinity here, nor an index outside.
TEST_P(LowerResolution, OutputsAreFiniteWhateverThePictureHolds) {
    constexpr Extent kExtent{19, 6};
    constexpr float kJunk[] = {0.0f, -1.0f, 1e6f, -1e15f, 1e15f, 3e38f, 1e-44f, 1e-20f, 1.0f};
    std::mt19937 random(11);
    const auto junk = [&] { return kJunk[random() % std::size(kJunk)]; };
    for (int round = 0; round < 4; ++round) {
        Still still = reference::makeStill(kExtent, round % 2 == 1);
        HostImage normal(PixelFormat::RGBA32F, kExtent), motion(PixelFormat::RGBA32F, kExtent);
        for (int i = 0; i < kExtent.widthPx * kExtent.heightPx; ++i) {
            still.depth.pixel(0, 0)[i] = junk();
            for (int c = 0; c < 4; ++c) normal.pixel(0, 0)[4 * i + c] = motion.pixel(0, 0)[4 * i + c] = junk();
        }
        still.normalWs = toHalf(normal.view());
        still.motion = toHalf(motion.view());
        for (const int stride : {2, 4}) {
            Picture p = picture(still, stride);
            const std::vector<glm::dvec3> low = randomIrradiance(p.low);
            const HostImage up = upsampled(p, low);
            const Interpolated in = interpolated(p, low, {});
            for (int i = 0; i < 4 * kExtent.widthPx * kExtent.heightPx; ++i) {
                ASSERT_TRUE(isFinite(up.pixel(0, 0)[i])) << i / 4;
                ASSERT_TRUE(isFinite(in.irradiance.pixel(0, 0)[i])) << i / 4;
            }
            for (const i32 pixel : in.listed) ASSERT_LT(pixel, kExtent.widthPx * kExtent.heightPx);
        }
    }
}

TEST_P(LowerResolution, RefusesOtherStridesAndExtents) {
    EXPECT_THROW(pickedExtent({8, 8}, 3), UsageError);
    const Still still = reference::makeStill({8, 8}, false);
    const Picture p = picture(still, 2);
    EXPECT_THROW(downsample_.enqueue({p.normalWs, p.depth, nullptr, p.lowNormalWs, p.lowDepth, nullptr}, 0),
                 UsageError);
    EXPECT_THROW(downsample_.enqueue({p.normalWs, p.depth, nullptr, p.lowNormalWs, p.lowDepth, nullptr}, 4),
                 DeviceError);
    downsample_.enqueue({p.normalWs, p.depth, nullptr, p.lowNormalWs, p.lowDepth, nullptr}, 2);
    device_.impl().queue.finish();
}

// The gather at the pixels of a list is the gather of all pixels there, and leaves the others as they are.
TEST_P(LowerResolution, AListIsGatheredAsAllPixelsAre) {
    RsmPackStage pack(device_);
    RsmGatherStage gather(device_);
    RsmGatherListStage gatherList(device_);
    Device::Impl& impl = device_.impl();
    const auto upload = [&](const auto& values) {
        const cl::Buffer buffer = impl.makeBuffer(values.size() * sizeof(values[0]));
        impl.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(values[0]), values.data());
        return buffer;
    };
    constexpr int kSamples = 5;
    const cl::Buffer pattern = upload(makeDiskPattern(kSamples)), noise = upload(makeRotationNoise());
    for (const Extent extent : {Extent{1, 1}, Extent{7, 3}, Extent{37, 11}, Extent{70, 67}}) {
        reference::SyntheticOptions options;
        options.extent = extent;
        options.skyFraction = extent.widthPx == 1 ? 0.0 : 0.2;
        const FrameImages images = reference::makeSyntheticFrame(options);
        const FrameInputs frame = images.inputs();
        FrameSurfaces inputs;
        transport_.enqueue(frame, inputs);
        if (device_.tuning().rsmRecords) pack.enqueue(inputs.rsm, inputs.lights);
        const Surface all(device_, PixelFormat::RGBA32F, extent), some(device_, PixelFormat::RGBA32F, extent);
        std::vector<i32> surfaces;
        for (i32 i = 0; i < extent.widthPx * extent.heightPx; ++i)
            if (images.depth.pixel(0, 0)[i] > 0.0f) surfaces.push_back(i);
        for (const Rotation rotation : {Rotation::Off, Rotation::Noise, Rotation::Tile}) {
            Settings settings;
            settings.sampleCount = kSamples;
            settings.radiusUv = 0.4f;
            settings.rotation = rotation;
            const FrameGeometry geometry{makeViewRays(frame.camera, extent), extent, inputs.rsm.sizePx,
                                         inputs.rsm.lightCount, inputs.shadowExtent};
            const RsmGatherParams params = makeParams(settings, geometry).gather;
            gather.enqueue({inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights, pattern, noise, all}, params);
            const HostImage expected = test::readSurface(device_, all);
            for (const std::size_t every : {1u, 3u, 40u, 100000u}) {
                SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx << ", every " << every);
                std::vector<i32> listed;  // backwards: in no order that a kernel could count on
                for (std::size_t i = every == 1 ? 0 : every / 2; i < surfaces.size(); i += every)
                    listed.insert(listed.begin(), surfaces[i]);
                std::vector<i32> padded = listed;
                padded.resize(std::size_t(extent.widthPx * extent.heightPx), -1);  // never to be read
                const cl::Buffer pixels = upload(padded), count = upload(std::vector<i32>{i32(listed.size())});
                const HostImage sevens =
                    imageOf(extent, std::vector<glm::dvec3>(padded.size(), glm::dvec3(7.0, 8.0, 9.0)));
                transport_.enqueueImage(sevens.view(), some, 0);
                gatherList.enqueue({inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights, pattern, noise, some},
                                   pixels, count, params);
                const HostImage actual = test::readSurface(device_, some);
                for (i32 i = 0; i < extent.widthPx * extent.heightPx; ++i) {
                    const bool isListed = std::find(listed.begin(), listed.end(), i) != listed.end();
                    for (int c = 0; c < 3; ++c) {
                        const float e = isListed ? expected.pixel(0, 0)[4 * i + c] : float(7 + c);
                        // The same operations in two programs, which a compiler may contract differently.
                        ASSERT_NEAR(actual.pixel(0, 0)[4 * i + c], e, isListed ? 1e-5f * std::fabs(e) : 0.0f) << i;
                    }
                }
            }
        }
        transport_.release();
    }
}

INSTANTIATE_TEST_SUITE_P(All, LowerResolution, testing::ValuesIn(reference::quickVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
