#pragma once
// A surface: what a kernel's SURFACE_IN and SURFACE_OUT stand for (kernels/common/surface.clh).

#include "compute/device_impl.hpp"
#include "earthshine/image.hpp"
#include "surface_layout.h"

namespace earthshine {

/// One or three numbers a pixel in the device's storage: an image of the format, or, whatever the format, planes of
/// 32-bit floats between two guards of SURFACE_GUARD floats, or packed pixels of 4 or 8 bytes between two of
/// SURFACE_GUARD pixels. Shared by copies. Planes and packed pixels are 0 at birth, an image is undefined.
class Surface {
public:
    Surface() = default;
    /// R32F has one number a pixel; RGBA16F and RGBA32F three (alpha is written as 1 and never read).
    /// Throws DeviceError if the device has no room or no such format.
    Surface(const Device& device, PixelFormat format, Extent extent);

    bool empty() const { return layout_.widthPx == 0; }
    PixelFormat format() const { return format_; }
    Extent extent() const { return {layout_.widthPx, layout_.heightPx}; }
    const SurfaceLayout& layout() const { return layout_; }
    const cl::Memory& memory() const { return memory_; }
    std::size_t sizeBytes() const { return sizeBytes_; }

private:
    PixelFormat format_ = PixelFormat::RGBA32F;
    SurfaceLayout layout_{0, 0, 0, 0};
    std::size_t sizeBytes_ = 0;
    cl::Memory memory_;
};

/// Makes `surface` anew if it is not one of this format and extent.
void ensure(const Device& device, Surface& surface, PixelFormat format, Extent extent);

cl::ImageFormat clImageFormat(PixelFormat format);

/// Throws DeviceError "stage: name is ..., must be ..." if a surface is not of the extent that a stage needs.
void requireExtent(const char* stage, const char* name, const Surface& surface, Extent extent);

}  // namespace earthshine
