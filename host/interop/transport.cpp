// The choice of a transport, and what happens when it fails.

#include "earthshine/transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iterator>
#include <thread>

#include "earthshine/error.hpp"
#include "earthshine/log.hpp"
#include "interop/external_memory_transport.hpp"
#include "interop/gl_sharing_transport.hpp"
#include "interop/transport_impl.hpp"

namespace earthshine {

namespace {

void checkTexture(const char* what, const GlTexture& texture, PixelFormat format, Extent extent) {
    if (texture.name == 0) throw InputError(fmt::format("{}: missing; a frame needs it", what));
    if (texture.format != format)
        throw InputError(fmt::format("{}: is {}, must be {}", what, formatName(texture.format), formatName(format)));
    if (texture.extent != extent)
        throw InputError(fmt::format("{}: is {} x {}, must be {} x {}", what, texture.extent.widthPx,
                                     texture.extent.heightPx, extent.widthPx, extent.heightPx));
}

// A small texture of one format, filled by GL, and what is left of it.
struct Pattern {
    // Odd sides, and more than one tile of any hardware.
    static constexpr Extent kExtent{131, 67};
    GlTexture texture;
    HostImage fromGl, fromCl;

    explicit Pattern(PixelFormat format)
        : texture{0, format, kExtent}, fromGl(numbers(format, 1)), fromCl(numbers(format, 7919)) {}

    // Numbers in [-3; 3), exact in a half, no two neighbours alike.
    static HostImage numbers(PixelFormat format, unsigned seed) {
        HostImage floats(format == PixelFormat::R32F ? PixelFormat::R32F : PixelFormat::RGBA32F, kExtent);
        const std::size_t count = floats.sizeBytes() / sizeof(float);
        for (std::size_t i = 0; i < count; ++i) {
            const unsigned hash = (unsigned(i) + seed) * 2654435761u;
            floats.pixel(0, 0)[i] = float((hash >> 16) % 768u) / 128.0f - 3.0f;
        }
        return format == PixelFormat::RGBA16F ? toHalf(floats.view()) : std::move(floats);
    }
};

void deleteTextures(SharedTextures& shared, std::vector<Pattern>& patterns) noexcept {
    for (Pattern& pattern : patterns) {
        if (pattern.texture.name == 0) continue;
        shared.forget(pattern.texture.name);
        shared.api().DeleteTextures(1, &pattern.texture.name);
    }
}

void expectEqual(const char* way, const HostImage& is, const HostImage& should) {
    if (std::memcmp(is.data(), should.data(), should.sizeBytes()) == 0) return;
    std::size_t first = 0;
    while (is.data()[first] == should.data()[first]) ++first;
    const std::size_t pixel = first / bytesPerPixel(should.format());
    throw DeviceError(fmt::format("round trip: {} of what {} does not arrive, first at pixel ({}, {})",
                                  formatName(should.format()), way, pixel % std::size_t(Pattern::kExtent.widthPx),
                                  pixel / std::size_t(Pattern::kExtent.widthPx)));
}

/// Waits at most so long for a command; throws DeviceError if it failed.
bool isDoneWithin(const cl::Event& event, double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + std::chrono::duration<double>(seconds);
    for (;;) {
        const cl_int status = event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>();
        if (status < 0) throw cl::Error(status, "a command");
        if (status == CL_COMPLETE) return true;
        if (Clock::now() > until) return false;
        std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
}

void exchange(SharedTextures& shared, Device::Impl& device, std::vector<Pattern>& patterns) {
    const GlApi& api = shared.api();
    constexpr auto kWidth = std::size_t(Pattern::kExtent.widthPx), kHeight = std::size_t(Pattern::kExtent.heightPx);
    constexpr double kPatienceS = 10.0;  // a driver whose semaphores go nowhere must not hang the program
    std::vector<SharedImage> images;
    {
        const GlPixelState state(api);
        for (Pattern& pattern : patterns) {
            api.GenTextures(1, &pattern.texture.name);
            api.BindTexture(gl::kTexture2d, pattern.texture.name);
            const GlPixels pixels = glPixels(pattern.texture.format);
            if (!shared.allocate(pattern.texture))
                api.TexImage2D(gl::kTexture2d, 0, int(pixels.internalFormat), int(kWidth), int(kHeight), 0,
                               pixels.format, pixels.type, nullptr);
            api.TexParameteri(gl::kTexture2d, gl::kTextureMaxLevel, 0);
            api.TexParameteri(gl::kTexture2d, gl::kTextureMinFilter, int(gl::kNearest));
            api.TexParameteri(gl::kTexture2d, gl::kTextureMagFilter, int(gl::kNearest));
            api.TexSubImage2D(gl::kTexture2d, 0, 0, 0, int(kWidth), int(kHeight), pixels.format, pixels.type,
                              pattern.fromGl.data());
        }
    }
    api.check("round trip: textures");
    for (const Pattern& pattern : patterns) images.push_back(shared.image(pattern.texture));

    TransportCost cost;
    shared.acquire(images, cost);
    device.checked("round trip: images", [&] {
        std::vector<HostImage> arrived;
        cl::Event last;
        for (std::size_t i = 0; i < patterns.size(); ++i) {
            arrived.emplace_back(patterns[i].texture.format, Pattern::kExtent);
            device.queue.enqueueReadImage(images[i].image, CL_FALSE, {0, 0, 0}, {kWidth, kHeight, 1}, 0, 0,
                                          arrived[i].data());
            device.queue.enqueueWriteImage(images[i].image, CL_FALSE, {0, 0, 0}, {kWidth, kHeight, 1}, 0, 0,
                                           patterns[i].fromCl.data(), nullptr, &last);
        }
        device.queue.flush();
        if (!isDoneWithin(last, kPatienceS)) {
            // What the device may still write into must outlive it.
            for (HostImage& image : arrived) static_cast<void>(new HostImage(std::move(image)));
            for (Pattern& pattern : patterns) static_cast<void>(new HostImage(std::move(pattern.fromCl)));
            throw DeviceError(fmt::format("round trip: OpenCL waits in vain for OpenGL ({} s)", kPatienceS));
        }
        for (std::size_t i = 0; i < patterns.size(); ++i) expectEqual("OpenGL writes", arrived[i], patterns[i].fromGl);
        return 0;
    });
    shared.release(images, cost);
    if (!api.finishWithin(kPatienceS))
        throw DeviceError(fmt::format("round trip: OpenGL waits in vain for OpenCL ({} s)", kPatienceS));
    for (const Pattern& pattern : patterns) {
        HostImage arrived(pattern.texture.format, Pattern::kExtent);
        {
            const GlPixelState state(api);
            const GlPixels pixels = glPixels(pattern.texture.format);
            api.BindTexture(gl::kTexture2d, pattern.texture.name);
            api.GetTexImage(gl::kTexture2d, 0, pixels.format, pixels.type, arrived.data());
        }
        api.check("round trip: reading back");
        expectEqual("OpenCL writes", arrived, pattern.fromCl);
    }
}

/// Throws DeviceError if a pattern does not arrive, in either direction, in one of a frame's formats.
void probe(SharedTextures& shared, const Device& device) {
    std::vector<Pattern> patterns;
    for (const PixelFormat format : {PixelFormat::R32F, PixelFormat::RGBA16F, PixelFormat::RGBA32F})
        patterns.emplace_back(format);
    shared.api().forgetErrors();
    try {
        exchange(shared, device.impl(), patterns);
    } catch (...) {
        deleteTextures(shared, patterns);
        throw;
    }
    deleteTextures(shared, patterns);
}

/// "gl-sharing: ...", whoever threw it.
std::string blamed(TransportKind kind, const DeviceError& error) {
    const std::string name = kTransportNames[int(kind)], what = error.what();
    return what.starts_with(name + ":") ? what : name + ": " + what;
}

struct Opened {
    Device device;
    std::unique_ptr<SharedTextures> shared;
};

/// Throws DeviceError with one line that says why this device and this context do not go together in this way.
Opened openShared(TransportKind kind, const Device& plain, const DeviceOptions& options, const GlContextHandle& gl) {
    const bool isGlSharing = kind == TransportKind::GlSharing;
    Opened opened{isGlSharing ? openWithGlSharing(plain, options, gl) : plain, nullptr};
    if (isGlSharing)
        opened.shared = std::make_unique<GlSharingTransport>(opened.device, gl);
    else
        opened.shared = std::make_unique<ExternalMemoryTransport>(opened.device, gl);
    probe(*opened.shared, opened.device);
    return opened;
}

GlDevice makeGlDevice(Opened opened, const GlContextHandle& gl, TransportKind kind, std::string reason,
                      bool fallsBack) {
    log(LogLevel::Info, fmt::format("transport {}: {}", kTransportNames[int(kind)], reason));
    auto impl = std::make_unique<Transport::Impl>(
        Transport::Impl{opened.device, gl, kind, std::move(reason), fallsBack, std::move(opened.shared), {}, {}});
    return {opened.device, Transport(std::move(impl))};
}

}  // namespace

void checkFrame(const GlFrame& frame, const Camera& camera, const std::vector<Light>& lights) {
    const Extent extent = frame.depth.extent;
    if (extent.widthPx <= 0 || extent.heightPx <= 0) throw InputError("depth: missing or empty; a frame needs it");
    checkTexture("albedo", frame.albedo, PixelFormat::RGBA16F, extent);
    checkTexture("normal", frame.normalWs, PixelFormat::RGBA16F, extent);
    checkTexture("depth", frame.depth, PixelFormat::R32F, extent);
    if (frame.motion.name != 0) checkTexture("motion", frame.motion, PixelFormat::RGBA16F, extent);
    if (frame.emission.name != 0) checkTexture("emission", frame.emission, PixelFormat::RGBA16F, extent);
    if (const std::string fault = faultOf(camera); !fault.empty()) throw InputError("camera: " + fault);
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (const std::string fault = faultOf(lights[i]); !fault.empty())
            throw InputError(fmt::format("lights[{}]: {}", i, fault));
    const int count = frame.lightCount;
    if (count < 0 || std::size_t(count) != lights.size())
        throw UsageError(fmt::format("lights: the frame has maps of {} lights, {} were given", count, lights.size()));
    if (count == 0) return;
    const Extent rsm = frame.rsmDepth.extent, shadow = frame.shadowDepth.extent;
    if (rsm.widthPx <= 0 || std::int64_t(rsm.widthPx) * count != rsm.heightPx)
        throw InputError(fmt::format("RSM depth: is {} x {}, must be {} squares below one another", rsm.widthPx,
                                     rsm.heightPx, count));
    if (shadow.widthPx <= 0 || shadow.heightPx <= 0 || shadow.heightPx % count != 0)
        throw InputError(fmt::format("shadow depth: is {} x {}, must be {} equal maps below one another",
                                     shadow.widthPx, shadow.heightPx, count));
    checkTexture("RSM depth", frame.rsmDepth, PixelFormat::R32F, rsm);
    checkTexture("RSM normal", frame.rsmNormalWs, PixelFormat::RGBA16F, rsm);
    checkTexture("RSM flux", frame.rsmFlux, PixelFormat::RGBA32F, rsm);
    checkTexture("shadow depth", frame.shadowDepth, PixelFormat::R32F, shadow);
}

void Transport::Impl::readBackInto(const GlFrame& frame, FrameInputs& inputs) {
    const GlApi api("host", gl.getProcAddress);
    cost.waitMs += timedMs([&] { api.Finish(); });
    cost.acquireMs += timedMs([&] { images = readBack(frame, inputs.camera, inputs.lights, gl.getProcAddress); });
    inputs = images.inputs();
    std::size_t bytes = 0;
    for (const HostImage* image : {&images.albedo, &images.normalWs, &images.depth, &images.motion, &images.emission,
                                   &images.rsmDepth, &images.rsmNormalWs, &images.rsmFlux, &images.shadowDepth})
        bytes += image->empty() ? 0 : image->sizeBytes();
    // Once out of GL; once more into the device's own memory, if it has some.
    cost.hostBytes += device.caps().unifiedMemory ? bytes : 2 * bytes;
}

void Transport::Impl::fallBack(const DeviceError& error) {
    reason = blamed(kind, error);
    log(LogLevel::Warning, fmt::format("transport {}; going on with host", reason));
    kind = TransportKind::Host;
}

bool Transport::Impl::enqueue(const GlFrame& frame, FrameInputs& inputs, FrameSurfaces& surfaces) {
    cost = {};
    if (kind != TransportKind::Host) {
        try {
            shared->enqueue(frame, inputs.lights, surfaces, cost);
            return true;
        } catch (const DeviceError& error) {
            if (!fallsBack) throw DeviceError("transport " + blamed(kind, error));
            fallBack(error);
        }
    }
    readBackInto(frame, inputs);
    return false;
}

Transport::Transport(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Transport::~Transport() = default;
Transport::Transport(Transport&&) noexcept = default;
Transport& Transport::operator=(Transport&&) noexcept = default;

TransportKind Transport::kind() const noexcept {
    return impl_->kind;
}
const std::string& Transport::reason() const noexcept {
    return impl_->reason;
}
const TransportCost& Transport::cost() const noexcept {
    return impl_->cost;
}
const FrameImages* Transport::hostImages() const noexcept {
    return impl_->images.depth.empty() ? nullptr : &impl_->images;
}
bool Transport::allocate(const GlTexture& texture) {
    if (impl_->kind == TransportKind::Host) return false;
    try {
        return impl_->shared->allocate(texture);
    } catch (const DeviceError& error) {
        if (!impl_->fallsBack) throw DeviceError("transport " + blamed(impl_->kind, error));
        impl_->fallBack(error);
        return false;
    }
}
void Transport::forget(unsigned name) noexcept {
    if (impl_->shared) impl_->shared->forget(name);
}

GlDevice openForGl(const DeviceCaps& caps, const DeviceOptions& options, const GlContextHandle& gl,
                   const std::string& transport) {
    const bool isAuto = transport == "auto";
    const auto named = std::find(std::begin(kTransportNames), std::end(kTransportNames), transport);
    if (!isAuto && named == std::end(kTransportNames))
        throw UsageError(fmt::format("transport: '{}' is none of auto, {}", transport,
                                     fmt::join(std::begin(kTransportNames), std::end(kTransportNames), ", ")));
    const Device plain(caps, options);
    if (!isAuto) {
        const auto kind = TransportKind(named - std::begin(kTransportNames));
        if (kind == TransportKind::Host) return makeGlDevice({plain, nullptr}, gl, kind, "asked for", false);
        try {
            return makeGlDevice(openShared(kind, plain, options, gl), gl, kind, "asked for", false);
        } catch (const DeviceError& error) {
            throw DeviceError("transport " + blamed(kind, error));
        }
    }
    std::string reasons;
    for (const TransportKind kind : {TransportKind::ExternalMemory, TransportKind::GlSharing}) {
        try {
            return makeGlDevice(openShared(kind, plain, options, gl), gl, kind,
                                "a round trip went well" + (reasons.empty() ? "" : "; " + reasons), true);
        } catch (const DeviceError& error) {
            reasons += fmt::format("{}{}", reasons.empty() ? "" : "; ", blamed(kind, error));
        }
    }
    return makeGlDevice({plain, nullptr}, gl, TransportKind::Host, reasons, false);
}

}  // namespace earthshine
