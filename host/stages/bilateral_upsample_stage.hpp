#pragma once
// Irradiance of a lower resolution brought to every pixel: the host half of kernels/bilateral_upsample.cl.

#include "bilateral_upsample_params.h"
#include "compute/kernel.hpp"

namespace earthshine {

/// Joint bilateral upsampling of irradiance (lx). Thread-compatible; owns its program, no images.
class BilateralUpsampleStage {
public:
    struct Images {
        const Surface& normalWs;
        const Surface& depth;
        const Surface& lowNormalWs;  ///< DownsampleStage's
        const Surface& lowDepth;
        const Surface& lowIrradiance;
        const Surface& outIrradiance;
    };
    explicit BilateralUpsampleStage(const Device& device) : kernel_(device, "bilateral_upsample") {}
    /// `cameraRays` are those of the full picture. Throws UsageError unless `stride` is 1, 2 or 4.
    void enqueue(const Images& images, const ViewRays& cameraRays, int stride);

private:
    Kernel kernel_;
};

}  // namespace earthshine
