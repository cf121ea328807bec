#pragma once
// What a surface holds, read without any kernel.

#include "compute/device_impl.hpp"
#include "compute/surface.hpp"

namespace earthshine::test {

/// R32F, or RGBA32F with alpha 1, in either storage. Waits for the queue.
inline HostImage readSurface(const Device& device, const Surface& surface) {
    Device::Impl& impl = device.impl();
    const Extent e = surface.extent();
    const bool isOne = surface.format() == PixelFormat::R32F;
    if (device.tuning().storage == Storage::Image) {
        HostImage image(surface.format(), e);
        impl.queue.enqueueReadImage(cl::Image2D(surface.memory()(), true), CL_TRUE, {0, 0, 0},
                                    {std::size_t(e.widthPx), std::size_t(e.heightPx), 1}, 0, 0, image.data());
        return toFloat(image.view());
    }
    const SurfaceLayout& l = surface.layout();
    std::vector<float> planes(surface.sizeBytes() / sizeof(float));
    impl.queue.enqueueReadBuffer(cl::Buffer(surface.memory()(), true), CL_TRUE, 0, surface.sizeBytes(), planes.data());
    HostImage image(isOne ? PixelFormat::R32F : PixelFormat::RGBA32F, e);
    for (int y = 0; y < e.heightPx; ++y) {
        for (int x = 0; x < e.widthPx; ++x) {
            float* pixel = image.pixel(x, y);
            if (!isOne) pixel[3] = 1.0f;
            for (int c = 0; c < (isOne ? 1 : 3); ++c)
                pixel[c] = planes[std::size_t(SURFACE_GUARD + c * l.planeStride + y * l.pitch + x)];
        }
    }
    return image;
}

}  // namespace earthshine::test
