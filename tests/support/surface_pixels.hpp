#pragma once
// What a surface holds, read without any kernel.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "compute/device_impl.hpp"
#include "compute/surface.hpp"

namespace earthshine::test {

/// Channel c of packed_three.clh's two words, from its table of bits.
inline float packedChannel(std::uint32_t low, std::uint32_t high, int c) {
    const std::uint64_t bits = std::uint64_t(high) << 32 | low;
    const int width = c == 2 ? 22 : 21;
    return std::bit_cast<float>(std::uint32_t(bits >> (21 * c)) << (32 - width));
}
/// The two words of three numbers that lose nothing.
inline std::array<std::uint32_t, 2> packedWords(const float* v) {
    std::uint64_t bits = 0;
    for (int c = 0; c < 3; ++c)
        bits |= std::uint64_t(std::bit_cast<std::uint32_t>(v[c]) >> (c == 2 ? 10 : 11)) << (21 * c);
    return {std::uint32_t(bits), std::uint32_t(bits >> 32)};
}

/// R32F, or RGBA32F with alpha 1, in any storage. Waits for the queue.
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
            if (!isOne && device.tuning().storage == Storage::Packed) {
                std::uint32_t words[2];
                std::memcpy(words, &planes[std::size_t(2 * (SURFACE_GUARD + y * l.pitch + x))], sizeof words);
                for (int c = 0; c < 3; ++c) pixel[c] = packedChannel(words[0], words[1], c);
                continue;
            }
            for (int c = 0; c < (isOne ? 1 : 3); ++c)
                pixel[c] = planes[std::size_t(SURFACE_GUARD + c * l.planeStride + y * l.pitch + x)];
        }
    }
    return image;
}

}  // namespace earthshine::test
