#include "earthshine/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "earthshine/error.hpp"
#include "interop/host_transport.hpp"
#include "interop/transport_impl.hpp"
#include "pipeline/indirect_pass.hpp"
#include "pipeline/make_params.hpp"
#include "stages/direct_light_stage.hpp"
#include "stages/exposure_stage.hpp"
#include "stages/frame_params.hpp"
#include "stages/interleave_stage.hpp"
#include "stages/modulate_stage.hpp"
#include "stages/tone_map_stage.hpp"

namespace earthshine {

struct Pipeline::Impl {
    explicit Impl(const Device& d)
        : device(d),
          transport(d),
          indirect(d),
          directLight(d),
          modulate(d),
          exposureStage(d),
          toneMap(d),
          interleave(d),
          exposure(d.impl().makeBuffer(sizeof(float))) {
        checkFormats();
    }

    Device device;
    HostTransport transport;
    IndirectPass indirect;
    DirectLightStage directLight;
    ModulateStage modulate;
    ExposureStage exposureStage;
    ToneMapStage toneMap;
    InterleaveStage interleave;

    FrameInputs frame;
    Transport* glTransport = nullptr;  ///< what brings the images of `frame`; null if it has them
    GlFrame glFrame;
    FrameSurfaces inputs, previous;  ///< of `previous` only normal and depth are kept
    ViewRays previousRays{};
    Extent extent;
    Surface directIrradiance, direct, color;
    Surface scratch;  ///< allocated by the first read that needs it
    cl::Buffer exposure, display, pixels;
    FrameParams params;
    bool hasFrame = false, hasRun = false;
    int frameIndex = 0;
    std::vector<StageTime> times;

    void bringIn() {
        if (glTransport && glTransport->impl().enqueue(glFrame, frame, inputs)) return;
        transport.enqueue(frame, inputs);
    }
    void allocate() {
        const Extent wanted = inputs.depth.extent();
        if (extent == wanted) return;
        extent = {};  // what throws halfway is allocated again by the next run
        for (Surface* surface : {&directIrradiance, &direct, &color})
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
                    device.caps().name, device.tuning().storage == Storage::Planar ? "image" : "planar"));
        }
    }

    std::size_t pixelCount() const { return std::size_t(extent.widthPx) * std::size_t(extent.heightPx); }

    Surface& scratchSurface() {
        if (scratch.empty()) scratch = Surface(device, PixelFormat::RGBA32F, extent);
        return scratch;
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

    void collectTimes() {
        times.clear();
        Device::Impl& impl = device.impl();
        for (const Launch& launch : impl.launches) {
            auto same =
                std::find_if(times.begin(), times.end(), [&](const StageTime& t) { return t.stage == launch.kernel; });
            if (same == times.end()) same = times.insert(times.end(), {launch.kernel, 0.0});
            if (!impl.options.profiling) continue;
            impl.checked("reading stage times", [&] {
                same->ms += launch.ms();
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
    impl_->glTransport = nullptr;
    impl_->hasFrame = true;
}

void Pipeline::setFrame(Transport& transport, const GlFrame& frame, const Camera& camera,
                        const std::vector<Light>& lights) {
    checkFrame(frame, camera, lights);
    impl_->frame = {camera, {}, lights, {}};
    impl_->glTransport = &transport;
    impl_->glFrame = frame;
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
    // What throws halfway leaves no history.
    const bool hadRun = std::exchange(p.hasRun, false);
    if (!hadRun) p.indirect.forget();

    const Impl::Borrowing borrowing(p);
    std::swap(p.inputs.normalWs, p.previous.normalWs);
    std::swap(p.inputs.depth, p.previous.depth);
    p.bringIn();
    p.allocate();
    const ViewRays rays = makeViewRays(p.frame.camera, p.extent);
    p.params = makeParams(
        settings, {rays, p.extent, p.inputs.rsm.sizePx, p.inputs.rsm.lightCount, p.inputs.shadowExtent, p.frameIndex,
                   p.previousRays, p.indirect.hasHistory(p.extent, settings), p.indirect.hasConfidence()});
    p.previousRays = rays;

    p.directLight.enqueue(
        {p.inputs.normalWs, p.inputs.depth, p.inputs.shadowDepth, p.inputs.lights, p.directIrradiance},
        p.params.directLight);
    p.indirect.enqueue(p.inputs, p.previous, p.params, progress);
    p.modulate.enqueue(
        {p.inputs.albedo, p.directIrradiance, p.inputs.emission.empty() ? nullptr : &p.inputs.emission, p.direct});
    p.modulate.enqueue({p.inputs.albedo, p.indirect.irradiance(), &p.direct, p.color});
    p.exposureStage.enqueue({p.color, p.inputs.depth, p.exposure}, p.params.exposure);
    p.toneMap.enqueue({p.color, p.exposure, p.display}, p.params.toneMap);

    p.device.impl().finish();
    p.collectTimes();
    p.hasRun = true;
    p.frameIndex = (p.frameIndex + 1) % (1 << 30);
    if (progress) progress(1.0);
}

void Pipeline::forgetHistory() {
    impl_->indirect.forget();
    impl_->frameIndex = 0;
}

HostImage Pipeline::read(Output output) {
    Impl& p = *impl_;
    p.requireRun();
    switch (output) {
        case Output::DirectIrradiance:
            return p.readSurface(p.directIrradiance);
        case Output::IndirectIrradiance:
            return p.readSurface(p.indirect.irradiance());
        case Output::Direct:
            return p.readSurface(p.direct);
        case Output::Color:
            return p.readSurface(p.color);
        case Output::Display:
            return p.readBuffer(p.display, PixelFormat::RGBA8);
        case Output::Indirect:
            break;
    }
    p.modulate.enqueue({p.inputs.albedo, p.indirect.irradiance(), nullptr, p.scratchSurface()});
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

int Pipeline::gatheredPixels() const {
    impl_->requireRun();
    return impl_->indirect.gatheredPixels();
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
