#include "interop/host_transport.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "earthshine/error.hpp"
#include "stages/frame_params.hpp"

namespace earthshine {

namespace {

void checkImage(const std::string& name, const ImageView& image, PixelFormat format, Extent extent) {
    if (image.empty()) throw InputError(fmt::format("{}: missing; a frame needs it", name));
    if (image.format != format)
        throw InputError(fmt::format("{}: is {}, must be {}", name, formatName(image.format), formatName(format)));
    if (image.extent != extent)
        throw InputError(fmt::format("{}: is {} x {}, must be {} x {}", name, image.extent.widthPx,
                                     image.extent.heightPx, extent.widthPx, extent.heightPx));
}

// Maps of one light after another in memory are one picture.
bool areContiguous(const std::vector<LightMaps>& maps, ImageView LightMaps::*member) {
    for (std::size_t i = 1; i < maps.size(); ++i) {
        const ImageView& previous = maps[i - 1].*member;
        if ((maps[i].*member).data != static_cast<const std::byte*>(previous.data) + previous.sizeBytes()) return false;
    }
    return true;
}

}  // namespace

void checkInputs(const FrameInputs& frame) {
    const GBuffer& g = frame.gbuffer;
    const Extent extent = g.depth.extent;
    if (extent.widthPx <= 0 || extent.heightPx <= 0) throw InputError("depth: missing or empty; a frame needs it");
    checkImage("albedo", g.albedo, PixelFormat::RGBA16F, extent);
    checkImage("normal", g.normalWs, PixelFormat::RGBA16F, extent);
    checkImage("depth", g.depth, PixelFormat::R32F, extent);
    if (!g.motion.empty()) checkImage("motion", g.motion, PixelFormat::RGBA16F, extent);
    if (!g.emission.empty()) checkImage("emission", g.emission, PixelFormat::RGBA16F, extent);
    if (const std::string fault = faultOf(frame.camera); !fault.empty()) throw InputError("camera: " + fault);
    if (frame.lights.size() != frame.lightMaps.size())
        throw InputError(fmt::format("lights: {} lights, but maps of {}", frame.lights.size(), frame.lightMaps.size()));
    if (frame.lights.empty()) return;
    const Extent rsm = frame.lightMaps[0].rsmDepth.extent, shadow = frame.lightMaps[0].shadowDepth.extent;
    if (rsm.widthPx != rsm.heightPx || rsm.widthPx <= 0)
        throw InputError(fmt::format("lights[0]: RSM depth is {} x {}, must be square", rsm.widthPx, rsm.heightPx));
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        const std::string light = fmt::format("lights[{}]: ", i);
        const LightMaps& maps = frame.lightMaps[i];
        if (const std::string fault = faultOf(frame.lights[i]); !fault.empty()) throw InputError(light + fault);
        checkImage(light + "RSM depth", maps.rsmDepth, PixelFormat::R32F, rsm);
        checkImage(light + "RSM normal", maps.rsmNormalWs, PixelFormat::RGBA16F, rsm);
        checkImage(light + "RSM flux", maps.rsmFlux, PixelFormat::RGBA32F, rsm);
        checkImage(light + "shadow depth", maps.shadowDepth, PixelFormat::R32F, shadow);
    }
}

HostTransport::HostTransport(const Device& device) : device_(device), unpack_(device) {}

// The maps of all lights stand below one another: in an image, whose height devices limit, or in planes and records,
// which kernels reach with 32-bit byte offsets.
void HostTransport::checkAtlas(const char* what, Extent map, int mapCount) const {
    const DeviceCaps& caps = device_.caps();
    const auto rows = std::int64_t(map.heightPx) * mapCount;
    if (device_.tuning().storage == Storage::Image &&
        (rows > std::int64_t(caps.maxImageSizePx[1]) || map.widthPx > std::int64_t(caps.maxImageSizePx[0])))
        throw DeviceError(
            fmt::format("{} {} of {} x {} are more than an image of \"{}\" holds ({} rows); make them smaller, or use "
                        "planar storage",
                        mapCount, what, map.widthPx, map.heightPx, caps.name, caps.maxImageSizePx[1]));
    constexpr std::int64_t kMaxTexels = (std::int64_t(1) << 32) / std::int64_t(sizeof(RsmRecord));
    if (rows * map.widthPx >= kMaxTexels)
        throw DeviceError(
            fmt::format("{} {} of {} x {} are more than the {} texels that kernels can address; make them smaller",
                        mapCount, what, map.widthPx, map.heightPx, kMaxTexels));
}

cl::Buffer HostTransport::borrow(const ImageView& image) {
    // In place: page-aligned memory, whose last page is readable to its end, so the size may round up to 64.
    const bool inPlace = device_.caps().unifiedMemory && reinterpret_cast<std::uintptr_t>(image.data) % 4096 == 0;
    const std::size_t bytes = inPlace ? (image.sizeBytes() + 63) / 64 * 64 : image.sizeBytes();
    const cl_mem_flags flags = CL_MEM_READ_ONLY | (inPlace ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR);
    Device::Impl& impl = device_.impl();
    impl.checked(fmt::format("a buffer of {} bytes over the host's pixels", bytes), [&] {
        borrowed_.emplace_back(impl.context, flags, bytes, const_cast<void*>(image.data));
        return 0;
    });
    return borrowed_.back();
}

void HostTransport::enqueueImage(const ImageView& image, const Surface& surface, int firstRowPx) {
    unpack_.enqueue(borrow(image), image.format, image.extent, surface, firstRowPx);
}

void HostTransport::enqueueMaps(const std::vector<LightMaps>& maps, ImageView LightMaps::*member,
                                const Surface& surface) {
    if (areContiguous(maps, member)) {
        ImageView all = maps[0].*member;
        all.extent.heightPx *= int(maps.size());
        enqueueImage(all, surface, 0);
        return;
    }
    for (std::size_t i = 0; i < maps.size(); ++i) {
        const ImageView& map = maps[i].*member;
        enqueueImage(map, surface, int(i) * map.extent.heightPx);
    }
}

void HostTransport::enqueue(const FrameInputs& frame, FrameSurfaces& out) {
    const Extent extent = frame.gbuffer.depth.extent;
    const int lightCount = int(frame.lights.size());
    const Extent rsm = lightCount > 0 ? frame.lightMaps[0].rsmDepth.extent : Extent{1, 1};
    const Extent shadow = lightCount > 0 ? frame.lightMaps[0].shadowDepth.extent : Extent{1, 1};
    const int mapCount = lightCount > 0 ? lightCount : 1;  // without a light, one texel that nobody reads

    checkAtlas("shadow maps", shadow, mapCount);
    checkAtlas("RSMs", rsm, mapCount);

    std::vector<LightParams> lights;
    for (const Light& light : frame.lights) lights.push_back(makeLightParams(light, rsm, shadow));
    lights.resize(std::size_t(mapCount));
    out.lights = device_.impl().makeBuffer(sizeof(LightParams) * lights.size());
    Device::Impl& impl = device_.impl();
    impl.checked("writing the lights", [&] {
        impl.queue.enqueueWriteBuffer(out.lights, CL_TRUE, 0, sizeof(LightParams) * lights.size(), lights.data());
        return 0;
    });

    ensure(device_, out.albedo, PixelFormat::RGBA16F, extent);
    ensure(device_, out.normalWs, PixelFormat::RGBA16F, extent);
    ensure(device_, out.depth, PixelFormat::R32F, extent);
    enqueueImage(frame.gbuffer.albedo, out.albedo, 0);
    enqueueImage(frame.gbuffer.normalWs, out.normalWs, 0);
    enqueueImage(frame.gbuffer.depth, out.depth, 0);
    const auto enqueueOptional = [&](const ImageView& image, Surface& surface) {
        if (image.empty()) {
            surface = {};
            return;
        }
        ensure(device_, surface, PixelFormat::RGBA16F, extent);
        enqueueImage(image, surface, 0);
    };
    enqueueOptional(frame.gbuffer.emission, out.emission);
    enqueueOptional(frame.gbuffer.motion, out.motion);

    const Extent rsmAtlas{rsm.widthPx, rsm.heightPx * mapCount};
    ensure(device_, out.rsm.depth, PixelFormat::R32F, rsmAtlas);
    ensure(device_, out.rsm.normalWs, PixelFormat::RGBA16F, rsmAtlas);
    ensure(device_, out.rsm.flux, PixelFormat::RGBA32F, rsmAtlas);
    ensure(device_, out.shadowDepth, PixelFormat::R32F, {shadow.widthPx, shadow.heightPx * mapCount});
    out.shadowExtent = shadow;
    if (device_.tuning().rsmRecords &&
        (out.rsm.sizePx != rsm.widthPx || out.rsm.lightCount != lightCount || !out.rsm.records()))
        out.rsm.records = device_.impl().makeBuffer(sizeof(RsmRecord) * std::size_t(rsmAtlas.widthPx) *
                                                    std::size_t(rsmAtlas.heightPx));
    out.rsm.sizePx = rsm.widthPx;
    out.rsm.lightCount = lightCount;
    if (lightCount > 0) {
        enqueueMaps(frame.lightMaps, &LightMaps::rsmDepth, out.rsm.depth);
        enqueueMaps(frame.lightMaps, &LightMaps::rsmNormalWs, out.rsm.normalWs);
        enqueueMaps(frame.lightMaps, &LightMaps::rsmFlux, out.rsm.flux);
        enqueueMaps(frame.lightMaps, &LightMaps::shadowDepth, out.shadowDepth);
    }
}

}  // namespace earthshine
