#pragma once
// Irradiance of a lower resolution where surfaces agree, and a list of the other pixels: the host half of
// kernels/interpolate.cl.

#include "compute/kernel.hpp"
#include "interpolate_params.h"

namespace earthshine {

/// When a texel of the lower resolution is suitable for a pixel. The defaults are ours; the paper gives none.
struct Suitability {
    float minCosine = 0.9f;       ///< [0; 1] - of the angle between the normals; 0.9 is 26 degrees
    float maxPlaneTexels = 1.0f;  ///< (widths of a texel > 0) - distance from the pixel's plane
};

/// Interpolates irradiance (lx) and lists the pixels to evaluate in full (RsmGatherListStage). Thread-compatible; owns
/// its program, no images.
class InterpolateStage {
public:
    struct Images {
        const Surface& normalWs;
        const Surface& depth;
        const Surface& lowNormalWs;  ///< DownsampleStage's
        const Surface& lowDepth;
        const Surface& lowIrradiance;
        const Surface& outIrradiance;
        const cl::Buffer& outPixels;  ///< i32, room for every pixel
        const cl::Buffer& outCount;   ///< i32: how many pixels are listed; set to 0 first by enqueue
    };
    explicit InterpolateStage(const Device& device) : device_(device), kernel_(device, "interpolate") {}
    /// `cameraRays` are those of the full picture. Throws UsageError unless `stride` is 1, 2 or 4.
    void enqueue(const Images& images, const ViewRays& cameraRays, int stride, const Suitability& suitability = {});

private:
    Device device_;
    Kernel kernel_;
};

}  // namespace earthshine
