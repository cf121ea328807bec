// rsm_gather: the disk estimator, tuned and naive. Where it gathers from records, packing them is part of its time.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>

#include "bench.hpp"
#include "interop/host_transport.hpp"
#include "measure.hpp"
#include "pipeline/make_params.hpp"
#include "room_frame.hpp"
#include "stages/blue_noise.hpp"
#include "stages/frame_params.hpp"
#include "stages/rsm_gather_stage.hpp"
#include "stages/rsm_pack_stage.hpp"

namespace earthshine::bench {

namespace {

constexpr int kRsmSizePx = 512;

void gather(benchmark::State& state, Extent extent, int sampleCount, const Variant& variant) {
    Device device(chosenDevice(), variant.options);
    Device::Impl& impl = device.impl();
    const FrameImages images = makeRoomFrame(extent, kRsmSizePx);
    const FrameInputs frame = images.inputs();
    FrameSurfaces inputs;
    HostTransport transport(device);
    transport.enqueue(frame, inputs);
    RsmPackStage packStage(device);

    const Surface irradiance(device, PixelFormat::RGBA32F, extent);
    const std::vector<f32x4> points = makeDiskPattern(sampleCount);
    const cl::Buffer pattern = impl.makeBuffer(points.size() * sizeof(f32x4));
    impl.queue.enqueueWriteBuffer(pattern, CL_TRUE, 0, points.size() * sizeof(f32x4), points.data());
    const std::vector<float> planes = makeRotationNoise();
    const cl::Buffer noise = impl.makeBuffer(planes.size() * sizeof(float));
    impl.queue.enqueueWriteBuffer(noise, CL_TRUE, 0, planes.size() * sizeof(float), planes.data());
    Settings settings;
    settings.sampleCount = sampleCount;
    settings.radiusUv = 0.3f;  // a disk that stays on the map: every sample costs its full price
    const FrameParams params =
        makeParams(settings, {makeViewRays(frame.camera, extent), extent, kRsmSizePx, 1, inputs.shadowExtent, 0});

    RsmGatherStage stage(device);
    const RsmGatherStage::Images surfaces{inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights,
                                          pattern,         noise,        irradiance};
    measure(state, device, [&] {
        if (device.tuning().rsmRecords) packStage.enqueue(inputs.rsm, inputs.lights);
        stage.enqueue(surfaces, params.gather);
    });
    const double samples = double(extent.widthPx) * extent.heightPx * sampleCount;
    state.counters["Msamples/s"] = benchmark::Counter(1e-6 * samples, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

void registerRsmGather() {
    for (const Extent extent : {Extent{1280, 720}, Extent{1920, 1080}}) {
        for (const Variant* variant : {&tuned(), &naive()}) {
            const std::string name =
                fmt::format("rsm_gather.{}x{}.8spp.{}", extent.widthPx, extent.heightPx, variant->name);
            benchmark::RegisterBenchmark(name.c_str(),
                                         [=](benchmark::State& state) { gather(state, extent, 8, *variant); })
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond)
                ->MinTime(0.5);
        }
    }
}

}  // namespace earthshine::bench
