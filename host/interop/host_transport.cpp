#include "interop/host_transport.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "earthshine/error.hpp"

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
    const GBuffer& g = frame.gbuffer;
    FrameShape shape{g.depth.extent, {1, 1}, {1, 1}, !g.motion.empty(), !g.emission.empty()};
    if (!frame.lights.empty()) {
        shape.rsm = frame.lightMaps[0].rsmDepth.extent;
        shape.shadow = frame.lightMaps[0].shadowDepth.extent;
    }
    prepareSurfaces(device_, shape, frame.lights, out);
    enqueueImage(g.albedo, out.albedo, 0);
    enqueueImage(g.normalWs, out.normalWs, 0);
    enqueueImage(g.depth, out.depth, 0);
    if (shape.hasEmission) enqueueImage(g.emission, out.emission, 0);
    if (shape.hasMotion) enqueueImage(g.motion, out.motion, 0);
    if (frame.lights.empty()) return;
    enqueueMaps(frame.lightMaps, &LightMaps::rsmDepth, out.rsm.depth);
    enqueueMaps(frame.lightMaps, &LightMaps::rsmNormalWs, out.rsm.normalWs);
    enqueueMaps(frame.lightMaps, &LightMaps::rsmFlux, out.rsm.flux);
    enqueueMaps(frame.lightMaps, &LightMaps::shadowDepth, out.shadowDepth);
}

}  // namespace earthshine
