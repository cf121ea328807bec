#pragma once
// A surface into plain pixels: the host half of kernels/interleave.cl.

#include "compute/kernel.hpp"

namespace earthshine {

/// Writes a surface of three numbers a pixel as RGBA32F, w = 1 or 0 on sky. Thread-compatible; owns its program, no
/// images.
class InterleaveStage {
public:
    struct Images {
        const Surface& color;
        const Surface& depth;
    };
    explicit InterleaveStage(const Device& device) : kernel_(device, "interleave") {}
    void enqueue(const Images& images, const cl::Buffer& outPixels);

private:
    Kernel kernel_;
};

}  // namespace earthshine
