#pragma once
// What a device can do at best, measured: the two sides of the roofline.

#include <algorithm>

#include "variants.hpp"

namespace earthshine::bench {

struct Roof {
    /// 1e9 bytes a second, read and written ones together, of data beyond any cache: a kernel's copy_surface and the
    /// driver's own clEnqueueCopyBuffer; the better is the roof.
    double kernelCopyGBs = 0.0, bufferCopyGBs = 0.0;
    double fmaGflops = 0.0;  ///< 1e9 multiplications and additions a second

    double copyGBs() const { return std::max(kernelCopyGBs, bufferCopyGBs); }
};

/// Takes a second or two. Throws DeviceError if the device cannot do either.
Roof measureRoof(const DeviceCaps& caps);

}  // namespace earthshine::bench
