// downsample, bilateral_upsample, interpolate, rsm_gather_list: a frame at half and quarter resolution, and what it
// costs to bring it back; beside them the gather at each resolution, which is what is saved.

#include <fmt/format.h>

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "gather_flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/bilateral_upsample_stage.hpp"
#include "stages/blue_noise.hpp"
#include "stages/downsample_stage.hpp"
#include "stages/frame_params.hpp"
#include "stages/interpolate_stage.hpp"
#include "stages/pick_grid.hpp"
#include "stages/rsm_gather_list_stage.hpp"
#include "stages/rsm_pack_stage.hpp"

namespace earthshine::bench {

namespace {

// pick_grid.clh. A pixel's plane: five dot products, its own distance (four products, 9), the width of a texel. The
// taps' fractions. A tap: its distance along the normal, how far that is off, the cosine kept in range; the bilinear
// weight.
constexpr double kPickPoint = 5 * kDot3 + 9 + (kFma + 1 + 2), kTapsAround = 2;
constexpr double kMatchTap = 9 + 1 + 2 + kDot3 + 2 + 1;
// Bilateral: the plane's weight, the cosine to the eighth, all of them together; sums; the mean.
constexpr double kBilateral = kPickPoint + kTapsAround + 4 * (kMatchTap + (kFma + 1) + 3 + 2 + kMad3 + 1) + 2 + kScale3;
// Interpolation: sums of light, weight and two counts; the mean.
constexpr double kInterpolation = kPickPoint + kTapsAround + 4 * (kMatchTap + kMad3 + 3) + 2 + kScale3;

/// All surfaces of a frame, once gathered at lower resolution.
struct Picked : Room {
    Picked(const Variant& variant, Extent full, int divisor)
        : Room(variant, full),
          stride(divisor),
          low(pickedExtent(full, divisor)),
          lowNormalWs(device, PixelFormat::RGBA16F, low),
          lowDepth(device, PixelFormat::R32F, low),
          lowIrradiance(device, PixelFormat::RGBA32F, low),
          irradiance(three()),
          listed(device.impl().makeBuffer(sizeof(i32) * std::size_t(pixels))),
          count(device.impl().makeBuffer(sizeof(i32))),
          noise(device.impl().upload(makeRotationNoise())) {
        settings.sampleCount = 8;
        settings.radiusUv = 0.3f;
        pattern = device.impl().upload(makeDiskPattern(settings.sampleCount));
        gather = params(settings).gather;
        if (device.tuning().rsmRecords) RsmPackStage(device).enqueue(inputs.rsm, inputs.lights);
        DownsampleStage(device).enqueue({inputs.normalWs, inputs.depth, nullptr, lowNormalWs, lowDepth, nullptr},
                                        stride);
        RsmGatherStage stage(device);
        gatherLow(stage);
        device.impl().finish();
    }

    void gatherLow(RsmGatherStage& stage) const {
        RsmGatherParams lowParams = gather;
        lowParams.cameraRays = pickedRays(rays, makePickGrid(extent, stride));
        stage.enqueue({lowNormalWs, lowDepth, inputs.rsm, inputs.lights, pattern, noise, lowIrradiance}, lowParams);
    }
    void interpolate(InterpolateStage& stage) const {
        stage.enqueue({inputs.normalWs, inputs.depth, lowNormalWs, lowDepth, lowIrradiance, irradiance, listed, count},
                      rays, stride);
    }
    i32 listedPixels() const {
        i32 value = 0;
        device.impl().queue.enqueueReadBuffer(count, CL_TRUE, 0, sizeof value, &value);
        return value;
    }
    double gatherFlopsAPixel() const { return gatherFlops(device.tuning().rsmRecords, settings); }

    int stride;
    Extent low;
    Settings settings;
    RsmGatherParams gather{};
    Surface lowNormalWs, lowDepth, lowIrradiance, irradiance;
    cl::Buffer listed, count, pattern, noise;
};
using Frame = std::shared_ptr<const Picked>;

// bytes: what is picked, in and out. No arithmetic.
Row downsample(const Frame& f) {
    const auto stage = std::make_shared<DownsampleStage>(f->device);
    return {.device = f->device,
            .run = launches(f->device,
                            [=] {
                                stage->enqueue({f->inputs.normalWs, f->inputs.depth, nullptr, f->lowNormalWs,
                                                f->lowDepth, nullptr},
                                               f->stride);
                            }),
            .work = {.bytes = 2 * f->bytes({f->lowNormalWs, f->lowDepth})}};
}

// As the rows of rsm_gather.
Row gatherLow(const Frame& f) {
    const auto stage = std::make_shared<RsmGatherStage>(f->device);
    const double part = double(f->low.widthPx) * f->low.heightPx / f->pixels;
    return {.device = f->device,
            .run = launches(f->device, [=] { f->gatherLow(*stage); }),
            .work = {.bytes = f->bytes({f->lowDepth, f->lowIrradiance}, {f->lowNormalWs}) +
                              f->rsmBytes(f->seenPixels * part * f->settings.sampleCount),
                     .flops = f->gatherFlopsAPixel() * f->seenPixels * part}};
}

// bytes: depth and out at every pixel, normals where there is no sky, the lower resolution's surfaces once.
double wayBackBytes(const Frame& f) {
    return f->bytes({f->inputs.depth, f->irradiance, f->lowDepth, f->lowNormalWs, f->lowIrradiance},
                    {f->inputs.normalWs});
}

Row upsample(const Frame& f) {
    const auto stage = std::make_shared<BilateralUpsampleStage>(f->device);
    return {.device = f->device,
            .run = launches(f->device,
                            [=] {
                                stage->enqueue({f->inputs.normalWs, f->inputs.depth, f->lowNormalWs, f->lowDepth,
                                                f->lowIrradiance, f->irradiance},
                                               f->rays, f->stride);
                            }),
            .work = {.bytes = wayBackBytes(f), .flops = kBilateral * f->seenPixels}};
}

Row interpolate(const Frame& f) {
    const auto stage = std::make_shared<InterpolateStage>(f->device);
    return {.device = f->device,
            .run = launches(f->device, [=] { f->interpolate(*stage); }),
            .work = {.bytes = wayBackBytes(f), .flops = kInterpolation * f->seenPixels}};
}

// bytes: a listed pixel's number, depth, normal and light; of the map what its samples read, at most all of it.
Row gatherList(const Frame& f) {
    InterpolateStage interpolateStage(f->device);
    f->interpolate(interpolateStage);
    const auto stage = std::make_shared<RsmGatherListStage>(f->device);
    const double listed = f->listedPixels();
    const double perPixel = 4 + f->bytes({f->inputs.depth, f->inputs.normalWs, f->irradiance}) / f->pixels;
    const double bytes = perPixel * listed + f->rsmBytes(listed * f->settings.sampleCount);
    return {.device = f->device,
            .run = launches(f->device,
                            [=] {
                                const FrameSurfaces& i = f->inputs;
                                stage->enqueue(
                                    {i.normalWs, i.depth, i.rsm, i.lights, f->pattern, f->noise, f->irradiance},
                                    f->listed, f->count, f->gather);
                            }),
            .work = {.bytes = bytes, .flops = f->gatherFlopsAPixel() * listed},
            .addCounters = [=](benchmark::State& state) { state.counters["of_all"] = listed / f->pixels; }};
}

}  // namespace

void addLowerResolutionRows() {
    const auto add = [](const char* stage, const char* setting, Row (*make)(const Frame&)) {
        for (const int stride : {2, 4})
            addRows(stage, usualExtents(), fmt::format("1_{}{}", stride, setting),
                    [=](const Variant& variant, Extent extent) {
                        return make(std::make_shared<const Picked>(variant, extent, stride));
                    });
    };
    add("downsample", "", downsample);
    add("rsm_gather", "_8spp", gatherLow);
    add("bilateral_upsample", "", upsample);
    add("interpolate", "", interpolate);
    add("rsm_gather_list", "_8spp", gatherList);
}

}  // namespace earthshine::bench
