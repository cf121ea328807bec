#pragma once
// Plain pixels in host memory, borrowed (ImageView) or owned (HostImage).
// Row 0 is the top of the picture; rows follow each other without padding; channels are interleaved.

#include <cstddef>
#include <cstdint>
#include <memory>

namespace earthshine {

/// The pixel formats that every OpenCL device and every GL can share. Floats are IEEE, native byte order.
enum class PixelFormat {
    R32F,     ///< one 32-bit float
    RGBA16F,  ///< four 16-bit floats
    RGBA32F,  ///< four 32-bit floats
    RGBA8,    ///< four bytes, [0; 255] stands for [0; 1]
};

/// Channels a pixel has: 1 or 4.
int channelCount(PixelFormat format) noexcept;

/// Bytes a pixel takes.
std::size_t bytesPerPixel(PixelFormat format) noexcept;

/// "R32F", "RGBA16F", ...
const char* formatName(PixelFormat format) noexcept;

struct Extent {
    int widthPx = 0;
    int heightPx = 0;
    bool operator==(const Extent&) const = default;
};

/// Borrowed pixels: the owner keeps them alive and unchanged for as long as the callee says. Empty if `data` is null.
struct ImageView {
    const void* data = nullptr;
    PixelFormat format = PixelFormat::RGBA32F;
    Extent extent;

    bool empty() const noexcept { return data == nullptr; }
    std::size_t sizeBytes() const noexcept {
        return bytesPerPixel(format) * std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
    }
};

/// Owned pixels, zero at birth. Memory is aligned to 4096 bytes and its size rounded up to a multiple of 4096, so that
/// OpenCL devices which share the host's memory use it in place (CL_MEM_USE_HOST_PTR). Movable, not copyable.
class HostImage {
public:
    HostImage() = default;
    HostImage(PixelFormat format, Extent extent);

    PixelFormat format() const noexcept { return format_; }
    Extent extent() const noexcept { return extent_; }
    bool empty() const noexcept { return !bytes_; }
    std::size_t sizeBytes() const noexcept { return view().sizeBytes(); }
    std::byte* data() noexcept { return bytes_.get(); }
    const std::byte* data() const noexcept { return bytes_.get(); }

    /// The pixel (x, y) of an image whose channels are 32-bit floats: a pointer to channelCount() of them.
    float* pixel(int x, int y) noexcept;
    const float* pixel(int x, int y) const noexcept;

    ImageView view() const noexcept { return {bytes_.get(), format_, extent_}; }
    /// The rows [firstRow; firstRow + rowCount), borrowed.
    ImageView rows(int firstRow, int rowCount) const noexcept;

private:
    struct Free {
        void operator()(std::byte* p) const noexcept;
    };
    PixelFormat format_ = PixelFormat::RGBA32F;
    Extent extent_;
    std::unique_ptr<std::byte, Free> bytes_;
};

/// The same picture with 32-bit float channels (RGBA8 becomes [0; 1]). Single-channel formats stay single-channel.
HostImage toFloat(const ImageView& image);

/// The same picture with 16-bit float channels, rounded to nearest even; `image` is RGBA32F.
HostImage toHalf(const ImageView& image);

/// IEEE half to float and back (to nearest even; beyond 65504 becomes infinity).
float floatFromHalf(std::uint16_t half) noexcept;
std::uint16_t halfFromFloat(float value) noexcept;

}  // namespace earthshine
