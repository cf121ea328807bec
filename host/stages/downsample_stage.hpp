#pragma once
// A G-buffer of lower resolution: the host half of kernels/downsample.cl.

#include "compute/kernel.hpp"
#include "downsample_params.h"

namespace earthshine {

/// Picks every second or fourth pixel of a G-buffer. Thread-compatible; owns its program, no images.
class DownsampleStage {
public:
    struct Images {
        const Surface& normalWs;
        const Surface& depth;
        const Surface* motion;       ///< may be null: nothing moved
        const Surface& outNormalWs;  ///< of pickedExtent
        const Surface& outDepth;
        const Surface* outMotion;  ///< null with `motion`
    };
    explicit DownsampleStage(const Device& device) : kernel_(device, "downsample") {}
    /// Throws UsageError unless `stride` is 1, 2 or 4.
    void enqueue(const Images& images, int stride);

private:
    Kernel kernel_;
};

}  // namespace earthshine
