#include "compute/surface.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>

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
    if (planeFloats * std::size_t(channels) > std::size_t(INT32_MAX))
        throw DeviceError(fmt::format("surface: {} x {} is more than a kernel's 32-bit offsets reach", extent.widthPx,
                                      extent.heightPx));
    layout_ = {extent.widthPx, extent.heightPx, pitch, int(planeFloats)};
    Device::Impl& impl = device.impl();
    const std::string what =
        fmt::format("a {} surface of {} x {}", formatName(format), extent.widthPx, extent.heightPx);
    if (impl.tuning.storage == Storage::Planar) {
        sizeBytes_ = planeFloats * std::size_t(channels) * sizeof(float);
        memory_ = impl.checked(what, [&] { return cl::Buffer(impl.context, CL_MEM_READ_WRITE, sizeBytes_); });
    } else {
        sizeBytes_ = bytesPerPixel(format) * std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
        memory_ = impl.checked(what, [&] {
            return cl::Image2D(impl.context, CL_MEM_READ_WRITE, clImageFormat(format), std::size_t(extent.widthPx),
                               std::size_t(extent.heightPx));
        });
    }
}

void checkImageFormats(Device::Impl& device) {
    constexpr int kSize = 4;
    for (PixelFormat format : {PixelFormat::R32F, PixelFormat::RGBA16F, PixelFormat::RGBA32F}) {
        const std::string what =
            fmt::format("image format {} (use --storage planar if the device cannot)", formatName(format));
        std::array<std::uint8_t, kSize * kSize * 16> in{}, out{};
        const std::size_t bytes = bytesPerPixel(format) * kSize * kSize;
        for (std::size_t i = 0; i < bytes; ++i) in[i] = std::uint8_t((i * 37) % 60);  // no exponent of all ones
        device.checked(what, [&] {
            const cl::Image2D image(device.context, CL_MEM_READ_WRITE, clImageFormat(format), kSize, kSize);
            const cl::array<cl::size_type, 3> origin{0, 0, 0}, region{kSize, kSize, 1};
            device.queue.enqueueWriteImage(image, CL_TRUE, origin, region, 0, 0, in.data());
            device.queue.enqueueReadImage(image, CL_TRUE, origin, region, 0, 0, out.data());
            return 0;
        });
        if (std::memcmp(in.data(), out.data(), bytes) != 0)
            throw DeviceError(fmt::format("{}: what is written does not read back on \"{}\"", what, device.caps.name));
    }
}

}  // namespace earthshine
