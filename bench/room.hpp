#pragma once
// The room's frame on a device, and surfaces beside it that hold something plausible: what is undefined (an image's
// memory at birth) could be zeros, which take short cuts, or denormals, which take long ones.

#include <initializer_list>

#include "interop/frame_surfaces.hpp"
#include "pipeline/make_params.hpp"
#include "variants.hpp"

namespace earthshine::bench {

inline constexpr int kRsmSizePx = 512;

struct Room {
    /// `moves`: motion vectors of 1.3 px along x and 0.6 px along y at every pixel; without, there are none.
    Room(const Variant& variant, Extent size, bool moves = false, int rsmSizePx = kRsmSizePx);

    /// The frame once more, on surfaces of its own: what the frame before left.
    FrameSurfaces another() const;
    /// Irradiance as few samples leave it: noise of a few hundred lx, the same every time.
    Surface noisy() const;
    /// One number a pixel, `value` everywhere.
    Surface constant(float value) const;
    /// Three numbers a pixel to write to.
    Surface three() const { return Surface(device, PixelFormat::RGBA32F, extent); }
    Surface one() const { return Surface(device, PixelFormat::R32F, extent); }

    FrameParams params(const Settings& settings, bool hasHistory = false) const;

    /// Work::bytes of a stage: `whole` surfaces are read or written at every pixel, `seen` ones only where there is no
    /// sky. Their padding and guards (kilobytes) are counted with them.
    double bytes(std::initializer_list<Surface> whole, std::initializer_list<Surface> seen = {}) const;
    /// Bytes that `samples` texels of the RSM's records, or of its three maps, take: at most all of them once.
    double rsmBytes(double samples) const;

    Device device;
    Extent extent;
    FrameSurfaces inputs;
    ViewRays rays{};
    double pixels = 0.0;
    double seenPixels = 0.0;  ///< that are not sky
};

}  // namespace earthshine::bench
