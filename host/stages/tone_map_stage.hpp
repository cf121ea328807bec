#pragma once
// Radiance to display bytes: the host half of kernels/tone_map.cl.

#include "compute/kernel.hpp"
#include "tone_map_params.h"

namespace earthshine {

/// Writes RGBA8, sRGB-encoded. Thread-compatible; owns its program, no images.
class ToneMapStage {
public:
    struct Images {
        const Surface& radiance;
        const cl::Buffer& exposure;    ///< one float (ExposureStage)
        const cl::Buffer& outDisplay;  ///< uchar4 a pixel
    };
    explicit ToneMapStage(const Device& device) : kernel_(device, "tone_map") {}
    void enqueue(const Images& images, const ToneMapParams& params);

private:
    Kernel kernel_;
};

}  // namespace earthshine
