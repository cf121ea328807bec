#include "earthshine/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "earthshine/error.hpp"
#include "interop/host_transport.hpp"
#include "pipeline/make_params.hpp"
#include "stages/blue_noise.hpp"
#include "stages/direct_light_stage.hpp"
#include "stages/exposure_stage.hpp"
#include "stages/frame_params.hpp"
#include "stages/interleave_stage.hpp"
#include "stages/modulate_stage.hpp"
#include "stages/rsm_gather_stage.hpp"
#include "stages/rsm_minify_stage.hpp"
#include "stages/rsm_pack_stage.hpp"
#include "stages/rsm_sum_stage.hpp"
#include "stages/tone_map_stage.hpp"

namespace earthshine {

struct Pipeline::Impl {
    explicit Impl(const Device& d)
        : device(d),
          transport(d),
          rsmPack(d),
          rsmMinify(d),
          rsmGather(d),
          rsmSum(d),
          directLight(d),
          modulate(d),
          exposureStage(d),
          toneMap(d),
          interleave(d),
          exposure(d.impl().makeBuffer(sizeof(float))) {
        uploadNoise();
        checkFormats();
    }

    Device device;
    HostTransport transport;
    RsmPackStage rsmPack;
    RsmMinifyStage rsmMinify;
    RsmGatherStage rsmGather;
    RsmSumStage rsmSum;
    DirectLightStage directLight;
    ModulateStage modulate;
    ExposureStage exposureStage;
    ToneMapStage toneMap;
    InterleaveStage interleave;

    FrameInputs frame;
    FrameSurfaces inputs;
    Extent extent;
    Surface directIrradiance, indirectIrradiance, direct, color;
    Surface scratch;  ///< allocated by the first read that needs it
    cl::Buffer exposure, display, pixels, pattern, noise;
    int patternSize = 0;
    DiskPattern patternKind = DiskPattern::Hammersley;
    FrameParams params;
    bool hasFrame = false, hasRun = false;
    int frameIndex = 0;
    std::vector<StageTime> times;

    void allocate() {
        const Extent wanted = inputs.depth.extent();
        if (extent == wanted) return;
        extent = {};  // what throws halfway is allocated again by the next run
        for (Surface* surface : {&directIrradiance, &indirectIrradiance, &direct, &color})
            *surface = Surface(device, PixelFormat::RGBA32F, wanted);
        scratch = {};
        const std::size_t count = std::size_t(wanted.widthPx) * std::size_t(wanted.heightPx);
        display = device.impl().makeBuffer(4 * count);
        pixels = device.impl().makeBuffer(16 * count);
        extent = wanted;
    }
    // Brings a few pixels in and out in every format that surfaces have: drivers list image formats that their kernels
    // then read wrong (PoCL 3.1: R16F).
    void checkFormats() {
        constexpr Extent kExtent{5, 3};
        HostImage in(PixelFormat::RGBA32F, kExtent), depth(PixelFormat::R32F, kExtent);
        for (int i = 0; i < 15; ++i) {
            for (int c = 0; c < 3; ++c) in.pixel(0, 0)[4 * i + c] = float(4 * i + c) / 8.0f - 3.0f;  // exact in half
            in.pixel(0, 0)[4 * i + 3] = float(i % 2);
            depth.pixel(0, 0)[i] = float(i % 2) * 7.25f;
        }
        const Surface depthSurface(device, PixelFormat::R32F, kExtent);
        transport.enqueueImage(depth.view(), depthSurface, 0);
        const cl::Buffer out = device.impl().makeBuffer(in.sizeBytes());
        for (PixelFormat format : {PixelFormat::RGBA16F, PixelFormat::RGBA32F}) {
            const Surface surface(device, format, kExtent);
            const Borrowing borrowing(*this);
            transport.enqueueImage(in.view(), surface, 0);
            interleave.enqueue({surface, depthSurface}, out);
            const HostImage back = readBuffer(out, PixelFormat::RGBA32F, kExtent);
            if (std::memcmp(back.data(), in.data(), in.sizeBytes()) != 0)
                throw DeviceError(fmt::format(
                    "{} or R32F surfaces do not come back as written on \"{}\"; use {} storage", formatName(format),
                    device.caps().name, device.tuning().storage == Storage::Image ? "planar" : "image"));
        }
    }

    std::size_t pixelCount() const { return std::size_t(extent.widthPx) * std::size_t(extent.heightPx); }

    Surface& scratchSurface() {
        if (scratch.empty()) scratch = Surface(device, PixelFormat::RGBA32F, extent);
        return scratch;
    }

    void uploadNoise() {
        const std::vector<float> planes = makeRotationNoise();
        noise = device.impl().makeBuffer(planes.size() * sizeof(float));
        write(noise, planes.data(), planes.size() * sizeof(float));
    }

    void write(const cl::Buffer& buffer, const void* data, std::size_t bytes) {
        Device::Impl& impl = device.impl();
        impl.checked("writing a table", [&] { return impl.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, data); });
    }

    void uploadPattern(int count, DiskPattern kind) {
        if (patternSize == count && patternKind == kind) return;
        const std::vector<f32x4> points = makeDiskPattern(count, kind);
        pattern = device.impl().makeBuffer(points.size() * sizeof(f32x4));
        write(pattern, points.data(), points.size() * sizeof(f32x4));
        patternSize = count;
        patternKind = kind;
    }

    // Bands of whole groups of rows, of about this many pairs of pixel and texel: some tenths of a second on two CPU
    // cores, so that progress shows and a GPU's display stays alive.
    void sumInBands(const std::function<void(double)>& progress) {
        constexpr double kPairsPerLaunch = 5e8;
        const int groupRows = device.tuning().localSizePx[1];
        const double pairsPerRow = double(extent.widthPx) * params.sum.rsmSizePx * double(params.sum.rsmSizePx) *
                                   std::max(inputs.rsm.lightCount, 1);
        const int rows =
            std::max(int(std::min(kPairsPerLaunch / pairsPerRow, double(extent.heightPx))) / groupRows, 1) * groupRows;
        for (int first = 0; first < extent.heightPx; first += rows) {
            RsmSumParams band = params.sum;
            band.firstRowPx = first;
            rsmSum.enqueue({inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights, indirectIrradiance}, band,
                           std::min(rows, extent.heightPx - first));
            if (progress) {
                finish();
                progress(double(std::min(first + rows, extent.heightPx)) / extent.heightPx);
            }
        }
    }

    // While the device reads the caller's memory in place, nothing may leave before the queue is done with it.
    class Borrowing {
    public:
        explicit Borrowing(Impl& owner) : owner_(owner) {}
        Borrowing(const Borrowing&) = delete;
        Borrowing& operator=(const Borrowing&) = delete;
        ~Borrowing() {
            try {
                owner_.device.impl().queue.finish();
            } catch (const cl::Error&) {  // already on the way out with the error that matters
            }
            owner_.transport.release();
        }

    private:
        Impl& owner_;
    };

    void finish() {
        Device::Impl& impl = device.impl();
        impl.checked("waiting for the frame", [&] { return impl.queue.finish(); });
    }

    void collectTimes() {
        times.clear();
        Device::Impl& impl = device.impl();
        for (const Launch& launch : impl.launches) {
            auto same =
                std::find_if(times.begin(), times.end(), [&](const StageTime& t) { return t.stage == launch.kernel; });
            if (same == times.end()) same = times.insert(times.end(), {launch.kernel, 0.0});
            if (!impl.options.profiling) continue;
            impl.checked("reading stage times", [&] {
                same->ms += 1e-6 * double(launch.event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                          launch.event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
                return 0;
            });
        }
        impl.launches.clear();
    }

    HostImage readBuffer(const cl::Buffer& buffer, PixelFormat format) { return readBuffer(buffer, format, extent); }

    HostImage readBuffer(const cl::Buffer& buffer, PixelFormat format, Extent imageExtent) {
        HostImage image(format, imageExtent);
        Device::Impl& impl = device.impl();
        impl.checked("reading an output", [&] {
            impl.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, image.sizeBytes(), image.data());
            return 0;
        });
        impl.launches.clear();  // what reading launched is not a stage of the frame
        return image;
    }

    HostImage readSurface(const Surface& surface) {
        interleave.enqueue({surface, inputs.depth}, pixels);
        return readBuffer(pixels, PixelFormat::RGBA32F);
    }

    void requireRun() const {
        if (!hasRun) throw UsageError("pipeline: there is no output before run()");
    }
};

Pipeline::Pipeline(const Device& device) : impl_(std::make_unique<Impl>(device)) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

void Pipeline::setFrame(const FrameInputs& frame) {
    checkInputs(frame);
    impl_->frame = frame;
    impl_->hasFrame = true;
}

void Pipeline::run(const Settings& settings, const std::function<void(double)>& progress) {
    validate(settings);
    Impl& p = *impl_;
    if (!p.hasFrame) throw UsageError("pipeline: setFrame() comes before run()");
    if (settings.rsmMinify > 1 && !p.device.tuning().rsmRecords)
        throw UsageError(
            fmt::format("rsm-minify: {} needs packed records, which are off on this device; turn "
                        "rsm-records on",
                        settings.rsmMinify));
    p.device.impl().launches.clear();
    p.hasRun = false;

    const Impl::Borrowing borrowing(p);
    p.transport.enqueue(p.frame, p.inputs);
    p.allocate();
    p.params = makeParams(settings, {makeViewRays(p.frame.camera, p.extent), p.inputs.rsm.sizePx,
                                     p.inputs.rsm.lightCount, p.inputs.shadowExtent, p.frameIndex});
    if (p.device.tuning().rsmRecords && p.inputs.rsm.lightCount > 0) {
        if (settings.rsmMinify > 1)
            p.rsmMinify.enqueue(p.inputs.rsm, p.inputs.lights, p.params.pack);
        else
            p.rsmPack.enqueue(p.inputs.rsm, p.inputs.lights);
    }

    p.directLight.enqueue(
        {p.inputs.normalWs, p.inputs.depth, p.inputs.shadowDepth, p.inputs.lights, p.directIrradiance},
        p.params.directLight);
    if (p.params.estimator == Estimator::Sum) {
        p.sumInBands(progress);
    } else {
        p.uploadPattern(p.params.gather.sampleCount, p.params.pattern);
        p.rsmGather.enqueue({p.inputs.normalWs, p.inputs.depth, p.inputs.rsm, p.inputs.lights, p.pattern, p.noise,
                             p.indirectIrradiance},
                            p.params.gather);
    }
    p.modulate.enqueue(
        {p.inputs.albedo, p.directIrradiance, p.inputs.emission.empty() ? nullptr : &p.inputs.emission, p.direct});
    p.modulate.enqueue({p.inputs.albedo, p.indirectIrradiance, &p.direct, p.color});
    p.exposureStage.enqueue({p.color, p.inputs.depth, p.exposure}, p.params.exposure);
    p.toneMap.enqueue({p.color, p.exposure, p.display}, p.params.toneMap);

    p.finish();
    p.collectTimes();
    p.hasRun = true;
    p.frameIndex = (p.frameIndex + 1) % (1 << 30);
    if (progress) progress(1.0);
}

HostImage Pipeline::read(Output output) {
    Impl& p = *impl_;
    p.requireRun();
    switch (output) {
        case Output::DirectIrradiance:
            return p.readSurface(p.directIrradiance);
        case Output::IndirectIrradiance:
            return p.readSurface(p.indirectIrradiance);
        case Output::Direct:
            return p.readSurface(p.direct);
        case Output::Color:
            return p.readSurface(p.color);
        case Output::Display:
            return p.readBuffer(p.display, PixelFormat::RGBA8);
        case Output::Indirect:
            break;
    }
    p.modulate.enqueue({p.inputs.albedo, p.indirectIrradiance, nullptr, p.scratchSurface()});
    return p.readSurface(p.scratch);
}

HostImage Pipeline::toDisplay(const ImageView& radiance) {
    Impl& p = *impl_;
    p.requireRun();
    if (radiance.format != PixelFormat::RGBA32F || radiance.extent != p.extent)
        throw UsageError(fmt::format("toDisplay: takes RGBA32F of {} x {}", p.extent.widthPx, p.extent.heightPx));
    const cl::Buffer bytes = p.device.impl().makeBuffer(4 * p.pixelCount());
    const Impl::Borrowing borrowing(p);
    p.transport.enqueueImage(radiance, p.scratchSurface(), 0);
    p.toneMap.enqueue({p.scratch, p.exposure, bytes}, p.params.toneMap);
    return p.readBuffer(bytes, PixelFormat::RGBA8);
}

float Pipeline::exposure() const {
    impl_->requireRun();
    float value = 0.0f;
    Device::Impl& impl = impl_->device.impl();
    impl.checked("reading the exposure", [&] {
        impl.queue.enqueueReadBuffer(impl_->exposure, CL_TRUE, 0, sizeof value, &value);
        return 0;
    });
    return value;
}

std::vector<StageTime> Pipeline::stageTimes() const {
    return impl_->times;
}

}  // namespace earthshine
