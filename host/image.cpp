#include "earthshine/image.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

namespace earthshine {

namespace {
constexpr std::size_t kPageBytes = 4096;  // what USE_HOST_PTR needs to be zero-copy (Intel: 4096 and a multiple of 64)
}

int channelCount(PixelFormat format) noexcept {
    return format == PixelFormat::R32F ? 1 : 4;
}

std::size_t bytesPerPixel(PixelFormat format) noexcept {
    switch (format) {
        case PixelFormat::R32F:
            return 4;
        case PixelFormat::RGBA16F:
            return 8;
        case PixelFormat::RGBA32F:
            return 16;
        case PixelFormat::RGBA8:
            return 4;
    }
    return 0;
}

const char* formatName(PixelFormat format) noexcept {
    switch (format) {
        case PixelFormat::R32F:
            return "R32F";
        case PixelFormat::RGBA16F:
            return "RGBA16F";
        case PixelFormat::RGBA32F:
            return "RGBA32F";
        case PixelFormat::RGBA8:
            return "RGBA8";
    }
    return "?";
}

HostImage::HostImage(PixelFormat format, Extent extent) : format_(format), extent_(extent) {
    const std::size_t bytes = (view().sizeBytes() + kPageBytes - 1) / kPageBytes * kPageBytes;
    if (bytes == 0) return;
    bytes_.reset(static_cast<std::byte*>(std::aligned_alloc(kPageBytes, bytes)));
    if (!bytes_) throw std::bad_alloc();
    std::memset(bytes_.get(), 0, bytes);
}

void HostImage::Free::operator()(std::byte* p) const noexcept {
    std::free(p);
}

float* HostImage::pixel(int x, int y) noexcept {
    return reinterpret_cast<float*>(bytes_.get()) +
           std::size_t(channelCount(format_)) * (std::size_t(y) * std::size_t(extent_.widthPx) + std::size_t(x));
}

const float* HostImage::pixel(int x, int y) const noexcept {
    return const_cast<HostImage*>(this)->pixel(x, y);
}

ImageView HostImage::rows(int firstRow, int rowCount) const noexcept {
    const std::size_t rowBytes = bytesPerPixel(format_) * std::size_t(extent_.widthPx);
    return {bytes_.get() + rowBytes * std::size_t(firstRow), format_, {extent_.widthPx, rowCount}};
}

float floatFromHalf(std::uint16_t half) noexcept {
    const std::uint32_t sign = std::uint32_t(half & 0x8000u) << 16;
    const std::uint32_t rest = half & 0x7fffu;
    if (rest >= 0x7c00u) return std::bit_cast<float>(sign | 0x7f800000u | ((rest & 0x3ffu) << 13));
    // The bits moved into place are 2^-112 of the value, denormals included.
    const float magnitude = std::bit_cast<float>(rest << 13) * 0x1p112f;
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(magnitude) | sign);
}

std::uint16_t halfFromFloat(float value) noexcept {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    const auto sign = std::uint16_t((bits >> 16) & 0x8000u);
    const float magnitude = std::fabs(value);
    if (std::isnan(value)) return std::uint16_t(sign | 0x7e00u);
    if (magnitude >= 65520.0f) return std::uint16_t(sign | 0x7c00u);
    if (magnitude < 0x1p-14f) return std::uint16_t(sign | std::uint16_t(std::nearbyint(magnitude * 0x1p24f)));
    std::uint32_t rest = std::bit_cast<std::uint32_t>(magnitude);
    rest += 0xfffu + ((rest >> 13) & 1u);  // to nearest, ties to even; a carry runs into the exponent as it should
    return std::uint16_t(sign | std::uint16_t((rest >> 13) - (112u << 10)));
}

HostImage toFloat(const ImageView& image) {
    const bool single = channelCount(image.format) == 1;
    HostImage result(single ? PixelFormat::R32F : PixelFormat::RGBA32F, image.extent);
    if (image.empty() || result.empty()) return result;
    const std::size_t count = std::size_t(image.extent.widthPx) * std::size_t(image.extent.heightPx) *
                              std::size_t(channelCount(image.format));
    float* out = result.pixel(0, 0);
    switch (image.format) {
        case PixelFormat::R32F:
        case PixelFormat::RGBA32F:
            std::memcpy(out, image.data, count * sizeof(float));
            break;
        case PixelFormat::RGBA16F: {
            const auto* in = static_cast<const std::uint16_t*>(image.data);
            for (std::size_t i = 0; i < count; ++i) out[i] = floatFromHalf(in[i]);
            break;
        }
        case PixelFormat::RGBA8: {
            const auto* in = static_cast<const std::uint8_t*>(image.data);
            for (std::size_t i = 0; i < count; ++i) out[i] = float(in[i]) / 255.0f;
            break;
        }
    }
    return result;
}

HostImage toHalf(const ImageView& image) {
    HostImage result(PixelFormat::RGBA16F, image.extent);
    if (image.empty() || result.empty()) return result;
    const auto* in = static_cast<const float*>(image.data);
    auto* out = reinterpret_cast<std::uint16_t*>(result.data());
    const std::size_t count = 4 * std::size_t(image.extent.widthPx) * std::size_t(image.extent.heightPx);
    for (std::size_t i = 0; i < count; ++i) out[i] = halfFromFloat(in[i]);
    return result;
}

}  // namespace earthshine
