#pragma once
// Plain pixels into a surface: the host half of kernels/unpack.cl.

#include "compute/kernel.hpp"
#include "unpack_params.h"

namespace earthshine {

/// Fills rows of a surface from plain pixels; what is not finite becomes 0. Thread-compatible; owns its program, no
/// images.
class UnpackStage {
public:
    explicit UnpackStage(const Device& device) : kernel_(device, "unpack") {}
    void enqueue(const cl::Buffer& pixels, PixelFormat format, Extent extent, const Surface& outSurface,
                 int firstRowPx);

private:
    Kernel kernel_;
};

}  // namespace earthshine
