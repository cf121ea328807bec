// downsample, bilateral_upsample, interpolate, rsm_gather_list: a frame at half and quarter resolution, and what it
// costs to bring it back; beside them the gather at each resolution, which is what is saved.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <functional>

#include "bench.hpp"
#include "interop/host_transport.hpp"
#include "measure.hpp"
#include "pipeline/make_params.hpp"
#include "room_frame.hpp"
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

constexpr int kRsmSizePx = 512;
constexpr int kSampleCount = 8;

/// All surfaces of a frame, once gathered at lower resolution.
struct Frame {
    Frame(const Variant& variant, Extent size, int s)
        : device(chosenDevice(), variant.options),
          extent(size),
          stride(s),
          low(pickedExtent(size, s)),
          lowNormalWs(device, PixelFormat::RGBA16F, low),
          lowDepth(device, PixelFormat::R32F, low),
          lowIrradiance(device, PixelFormat::RGBA32F, low),
          irradiance(device, PixelFormat::RGBA32F, extent),
          pixels(device.impl().makeBuffer(sizeof(i32) * std::size_t(extent.widthPx) * std::size_t(extent.heightPx))),
          count(device.impl().makeBuffer(sizeof(i32))) {
        const FrameImages images = makeRoomFrame(extent, kRsmSizePx);
        const FrameInputs frame = images.inputs();
        HostTransport transport(device);
        transport.enqueue(frame, inputs);
        device.impl().queue.finish();
        rays = makeViewRays(frame.camera, extent);
        pattern = upload(makeDiskPattern(kSampleCount));
        noise = upload(makeRotationNoise());
        Settings settings;
        settings.sampleCount = kSampleCount;
        settings.radiusUv = 0.3f;
        params = makeParams(settings, {rays, extent, kRsmSizePx, 1, inputs.shadowExtent}).gather;
        if (device.tuning().rsmRecords) RsmPackStage(device).enqueue(inputs.rsm, inputs.lights);
        DownsampleStage(device).enqueue({inputs.normalWs, inputs.depth, nullptr, lowNormalWs, lowDepth, nullptr},
                                        stride);
        RsmGatherStage stage(device);
        gatherLow(stage);
        device.impl().queue.finish();
    }

    template <class T>
    cl::Buffer upload(const std::vector<T>& values) {
        cl::Buffer buffer = device.impl().makeBuffer(values.size() * sizeof(T));
        device.impl().queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
        return buffer;
    }

    void gatherLow(RsmGatherStage& stage) {
        RsmGatherParams lowParams = params;
        lowParams.cameraRays = pickedRays(rays, makePickGrid(extent, stride));
        stage.enqueue({lowNormalWs, lowDepth, inputs.rsm, inputs.lights, pattern, noise, lowIrradiance}, lowParams);
    }

    RsmGatherStage::Images gathered() {
        return {inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights, pattern, noise, irradiance};
    }

    Device device;
    Extent extent;
    int stride;
    Extent low;
    FrameSurfaces inputs;
    ViewRays rays{};
    RsmGatherParams params{};
    Surface lowNormalWs, lowDepth, lowIrradiance, irradiance;
    cl::Buffer pixels, count, pattern, noise;
};

void downsample(benchmark::State& state, Frame& f) {
    DownsampleStage stage(f.device);
    measure(state, f.device, [&] {
        stage.enqueue({f.inputs.normalWs, f.inputs.depth, nullptr, f.lowNormalWs, f.lowDepth, nullptr}, f.stride);
    });
}

void gatherLow(benchmark::State& state, Frame& f) {
    RsmGatherStage stage(f.device);
    measure(state, f.device, [&] { f.gatherLow(stage); });
}

void upsample(benchmark::State& state, Frame& f) {
    BilateralUpsampleStage stage(f.device);
    measure(state, f.device, [&] {
        stage.enqueue({f.inputs.normalWs, f.inputs.depth, f.lowNormalWs, f.lowDepth, f.lowIrradiance, f.irradiance},
                      f.rays, f.stride);
    });
}

void interpolate(InterpolateStage& stage, Frame& f) {
    stage.enqueue({f.inputs.normalWs, f.inputs.depth, f.lowNormalWs, f.lowDepth, f.lowIrradiance, f.irradiance,
                   f.pixels, f.count},
                  f.rays, f.stride);
}

void interpolate(benchmark::State& state, Frame& f) {
    InterpolateStage stage(f.device);
    measure(state, f.device, [&] { interpolate(stage, f); });
}

void gatherList(benchmark::State& state, Frame& f) {
    InterpolateStage interpolateStage(f.device);
    interpolate(interpolateStage, f);
    RsmGatherListStage stage(f.device);
    measure(state, f.device, [&] { stage.enqueue(f.gathered(), f.pixels, f.count, f.params); });
    i32 count = 0;
    f.device.impl().queue.enqueueReadBuffer(f.count, CL_TRUE, 0, sizeof count, &count);
    state.counters["pixels"] = count;
    state.counters["of all"] = double(count) / (double(f.extent.widthPx) * f.extent.heightPx);
}

}  // namespace

void registerLowerResolution() {
    struct Part {
        const char* name;
        void (*run)(benchmark::State&, Frame&);
    };
    constexpr Part kParts[] = {{"downsample", downsample},
                               {"rsm_gather.8spp", gatherLow},
                               {"bilateral_upsample", upsample},
                               {"interpolate", interpolate},
                               {"rsm_gather_list.8spp", gatherList}};
    constexpr Extent kExtent{1920, 1080};
    for (const int stride : {2, 4}) {
        for (const Part& part : kParts) {
            for (const Variant* variant : {&tuned(), &naive()}) {
                const std::string name = fmt::format("lower_resolution.{}x{}.1_{}.{}.{}", kExtent.widthPx,
                                                     kExtent.heightPx, stride, part.name, variant->name);
                benchmark::RegisterBenchmark(name.c_str(),
                                             [=](benchmark::State& state) {
                                                 Frame frame(*variant, kExtent, stride);
                                                 part.run(state, frame);
                                             })
                    ->UseManualTime()
                    ->Unit(benchmark::kMillisecond)
                    ->MinTime(0.5);
            }
        }
    }
}

}  // namespace earthshine::bench
