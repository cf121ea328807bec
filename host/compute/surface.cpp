#include "compute/surface.hpp"

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine {

cl::ImageFormat clImageFormat(PixelFormat format) {
    switch (format) {
        case PixelFormat::R32F:
            return {CL_R, CL_FLOAT};
        case PixelFormat::RGBA16F:
            return {CL_RGBA, CL_HALF_FLOAT};
        case PixelFormat::RGBA32F:
            return {CL_RGBA, CL_FLOAT};
        case PixelFormat::RGBA8:
            return {CL_RGBA, CL_UNORM_INT8};
    }
    return {CL_RGBA, CL_FLOAT};
}

Surface::Surface(const Device& device, PixelFormat format, Extent extent) : format_(format) {
    constexpr int kMaxLanes = 16;
    const int channels = format == PixelFormat::R32F ? 1 : 3;
    const int pitch = (extent.widthPx + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
    const auto planeFloats = std::size_t(pitch) * std::size_t(extent.heightPx);
    // unpack counts four channels a pixel, and packed pixels are 8 bytes, of 32-bit offsets, guards included.
    if ((planeFloats + 2 * SURFACE_GUARD) * 4 > std::size_t(INT32_MAX))
        throw DeviceError(fmt::format("surface: {} x {} is more than a kernel's 32-bit offsets reach", extent.widthPx,
                                      extent.heightPx));
    layout_ = {extent.widthPx, extent.heightPx, pitch, int(planeFloats)};
    Device::Impl& impl = device.impl();
    const std::string what =
        fmt::format("a {} surface of {} x {}", formatName(format), extent.widthPx, extent.heightPx);
    if (impl.tuning.storage != Storage::Image) {
        sizeBytes_ = impl.tuning.storage == Storage::Planar
                         ? (planeFloats * std::size_t(channels) + 2 * SURFACE_GUARD) * sizeof(float)
                         : (planeFloats + 2 * SURFACE_GUARD) * sizeof(float) * (channels == 1 ? 1 : 2);
        memory_ = impl.checked(what, [&] {
            const cl::Buffer buffer(impl.context, CL_MEM_READ_WRITE, sizeBytes_);
            // Padding and guards are read, if only to be masked: they must be finite.
            impl.queue.enqueueFillBuffer(buffer, 0.0f, 0, sizeBytes_);
            return buffer;
        });
    } else {
        // Asked here: NVIDIA's driver (580.159) makes images wider than it says it can.
        const auto& most = impl.caps.maxImageSizePx;
        if (std::size_t(extent.widthPx) > most[0] || std::size_t(extent.heightPx) > most[1])
            throw DeviceError(
                fmt::format("{}: {} takes images of up to {} x {}", what, impl.caps.name, most[0], most[1]));
        sizeBytes_ = bytesPerPixel(format) * std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
        memory_ = impl.checked(what, [&] {
            return cl::Image2D(impl.context, CL_MEM_READ_WRITE, clImageFormat(format), std::size_t(extent.widthPx),
                               std::size_t(extent.heightPx));
        });
    }
    impl.allocatedBytes += sizeBytes_;
}

void ensure(const Device& device, Surface& surface, PixelFormat format, Extent extent) {
    if (surface.empty() || surface.format() != format || surface.extent() != extent)
        surface = Surface(device, format, extent);
}

void requireExtent(const char* stage, const char* name, const Surface& surface, Extent extent) {
    if (surface.extent() == extent) return;
    throw DeviceError(fmt::format("{}: {} is {} x {}, must be {} x {}", stage, name, surface.extent().widthPx,
                                  surface.extent().heightPx, extent.widthPx, extent.heightPx));
}

}  // namespace earthshine
