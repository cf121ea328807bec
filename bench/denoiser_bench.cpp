// The stages after the gather, the whole of indirect light, and the device's copy rate that they are measured by.

#include <functional>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bench.hpp"
#include "interop/host_transport.hpp"
#include "measure.hpp"
#include "pipeline/indirect_pass.hpp"
#include "room_frame.hpp"
#include "stages/frame_params.hpp"
#include "stages/modulate_stage.hpp"
#include "stages/rsm_minify_stage.hpp"

namespace earthshine::bench {

namespace {

constexpr int kRsmSizePx = 512;

/// A frame's surfaces, with a motion of 1.3 px along x and 0.6 px along y if it moves.
struct Frame {
    Frame(const Variant& variant, Extent size, bool moves = false)
        : device(chosenDevice(), variant.options), extent(size), pixels(double(size.widthPx) * size.heightPx) {
        FrameImages images = makeRoomFrame(extent, kRsmSizePx);
        if (moves) {
            HostImage motion(PixelFormat::RGBA32F, extent);
            for (int y = 0; y < extent.heightPx; ++y)
                for (int x = 0; x < extent.widthPx; ++x) {
                    motion.pixel(x, y)[0] = 1.3f;
                    motion.pixel(x, y)[1] = 0.6f;
                }
            images.motion = toHalf(motion.view());
        } else {
            images.motion = {};
        }
        const FrameInputs frame = images.inputs();
        HostTransport transport(device);
        transport.enqueue(frame, inputs);
        device.impl().finish();
        rays = makeViewRays(frame.camera, extent);
    }

    Surface three() const { return Surface(device, PixelFormat::RGBA32F, extent); }
    Surface one() const { return Surface(device, PixelFormat::R32F, extent); }
    FrameParams params(const Settings& settings, bool hasHistory) const {
        FrameGeometry geometry{rays, extent, kRsmSizePx, 1, inputs.shadowExtent};
        geometry.previousRays = rays;
        geometry.hasHistory = hasHistory;
        return makeParams(settings, geometry);
    }

    Device device;
    Extent extent;
    double pixels;
    FrameSurfaces inputs;
    ViewRays rays{};
};

constexpr double kFloat = sizeof(float);

void copy(benchmark::State& state, const Variant& variant, Extent extent) {
    const Device device(chosenDevice(), variant.options);
    Device::Impl& impl = device.impl();
    const std::size_t bytes = 16 * std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
    const cl::Buffer from = impl.makeBuffer(bytes), to = impl.makeBuffer(bytes);
    measure(
        state, device,
        [&] {
            cl::Event event;
            impl.queue.enqueueCopyBuffer(from, to, 0, 0, bytes, nullptr, &event);
            impl.launches.push_back({"copy", event});
        },
        2.0 * double(bytes));
}

void temporal(benchmark::State& state, const Variant& variant, Extent extent, bool moves) {
    const Frame f(variant, extent, moves);
    TemporalStage stage(f.device);
    const Surface in = f.three(), out = f.three(), outLength = f.one(), outMoment = f.one();
    const HistorySurfaces history{f.three(), f.one(), f.one()};
    const cl::Buffer confidence = f.device.impl().makeBuffer(sizeof(float));
    const FrameParams params = f.params(settingsOf(Preset::Balanced), true);
    const Surface* motion = f.inputs.motion.empty() ? nullptr : &f.inputs.motion;
    measure(
        state, f.device,
        [&] {
            stage.enqueue({in, f.inputs.normalWs, f.inputs.depth, motion, f.inputs.normalWs, f.inputs.depth, history,
                           confidence, out, outLength, outMoment},
                          params.temporal);
        },
        // normal and depth now and then, sample, history of five numbers; five out; motion
        kFloat * (8 + 3 + 5 + 5 + (moves ? 3 : 0)) * f.pixels);
}

void historyCheck(benchmark::State& state, const Variant& variant, Extent extent) {
    const Frame f(variant, extent);
    HistoryCheckStage stage(f.device);
    const Surface in = f.three(), accumulated = f.three();
    const Extent tiles = HistoryCheckStage::tiles(extent);
    const cl::Buffer confidence =
        f.device.impl().makeBuffer(sizeof(float) * std::size_t(tiles.widthPx) * std::size_t(tiles.heightPx));
    const FrameParams params = f.params(settingsOf(Preset::Balanced), true);
    measure(
        state, f.device,
        [&] {
            stage.enqueue({in, accumulated, confidence}, params.historyCheck);
        },
        kFloat * 6 * f.pixels);
}

void tileAverage(benchmark::State& state, const Variant& variant, Extent extent) {
    const Frame f(variant, extent);
    TileAverageStage stage(f.device);
    const Surface in = f.three(), out = f.three();
    const TileAverageParams params = f.params(Settings(), false).tileAverage;
    measure(
        state, f.device,
        [&] {
            stage.enqueue({in, f.inputs.normalWs, f.inputs.depth, out}, params);
        },
        kFloat * (3 + 3 + 1 + 3) * f.pixels);  // irradiance, normal, depth; out
}

/// Pass `pass` of a kernel's iterations: step 1, 2, 4, ...
void atrous(benchmark::State& state, const Variant& variant, Extent extent, FilterKernel kernel, std::size_t pass) {
    const Frame f(variant, extent);
    AtrousStage stage(f.device);
    const Surface in = f.three(), out = f.three(), length = f.one(), moment = f.one();
    Settings settings = settingsOf(Preset::Balanced);
    settings.filterKernel = kernel;
    const AtrousParams params = f.params(settings, true).filterPasses.at(pass);
    measure(
        state, f.device,
        [&] {
            stage.enqueue({in, f.inputs.normalWs, f.inputs.depth, length, moment, out}, params);
        },
        kFloat * (3 + 3 + 1 + 1 + 3) * f.pixels);  // irradiance, normal, depth, length; out
}

void minify(benchmark::State& state, const Variant& variant, int blockPx) {
    const Frame f(variant, {64, 64});
    RsmMinifyStage stage(f.device);
    Settings settings;
    settings.rsmMinify = blockPx;
    const FrameParams params = f.params(settings, false);
    measure(state, f.device, [&] { stage.enqueue(f.inputs.rsm, f.inputs.lights, params.pack); });
}

/// Pack, gather of 8 samples, temporal, history check, `iterations` separable iterations, modulate.
void indirect(benchmark::State& state, const Variant& variant, Extent extent, int iterations) {
    const Frame f(variant, extent);
    IndirectPass pass(f.device);
    ModulateStage modulate(f.device);
    const Surface radiance = f.three();
    Settings settings = settingsOf(Preset::Balanced);
    settings.filterIterations = iterations;
    bool hasHistory = false;
    measure(state, f.device, [&] {
        pass.enqueue(f.inputs, f.inputs, f.params(settings, hasHistory), {});
        modulate.enqueue({f.inputs.albedo, pass.irradiance(), nullptr, radiance});
        hasHistory = true;
    });
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
    benchmark::RegisterBenchmark(name.c_str(), [run](benchmark::State& state) { run(state); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->MinTime(0.5);
}

}  // namespace

void registerDenoiser() {
    for (const Extent extent : {Extent{1280, 720}, Extent{1920, 1080}}) {
        const std::string size = fmt::format("{}x{}", extent.widthPx, extent.heightPx);
        add("copy." + size + ".device", [=](auto& state) { copy(state, tuned(), extent); });
        for (const Variant* v : {&tuned(), &naive()}) {
            const Variant& variant = *v;
            const auto addStage = [&](const std::string& stage, const std::function<void(benchmark::State&)>& run) {
                add(fmt::format("{}.{}.{}", stage, size, variant.name), run);
            };
            addStage("temporal_still", [&variant, extent](auto& s) { temporal(s, variant, extent, false); });
            addStage("temporal_moving", [&variant, extent](auto& s) { temporal(s, variant, extent, true); });
            addStage("history_check", [&variant, extent](auto& s) { historyCheck(s, variant, extent); });
            addStage("tile_average", [&variant, extent](auto& s) { tileAverage(s, variant, extent); });
            const auto addPass = [&](const char* name, FilterKernel kernel, std::size_t pass) {
                addStage(name, [=, &variant](auto& s) { atrous(s, variant, extent, kernel, pass); });
            };
            addPass("atrous_row_step1", FilterKernel::Separable, 0);
            addPass("atrous_column_step1", FilterKernel::Separable, 1);
            addPass("atrous_row_step4", FilterKernel::Separable, 4);
            addPass("atrous_column_step4", FilterKernel::Separable, 5);
            addPass("atrous_3x3", FilterKernel::Square3x3, 0);
            addPass("atrous_5x5", FilterKernel::Square5x5, 0);
            addStage("indirect.8spp.3iterations", [&variant, extent](auto& s) { indirect(s, variant, extent, 3); });
            addStage("indirect.8spp.5iterations", [&variant, extent](auto& s) { indirect(s, variant, extent, 5); });
        }
    }
    for (const int blockPx : {2, 4, 8})
        add(fmt::format("rsm_minify.{}to{}.device", kRsmSizePx, kRsmSizePx / blockPx),
            [=](auto& state) { minify(state, tuned(), blockPx); });
}

}  // namespace earthshine::bench
