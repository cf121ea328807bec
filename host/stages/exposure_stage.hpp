#pragma once
// How bright the display shows a picture: the host half of kernels/luminance_sum.cl and exposure.cl.

#include "compute/kernel.hpp"
#include "exposure_params.h"

namespace earthshine {

/// Computes the exposure factor of a picture into a buffer of one float. Thread-compatible; owns its programs and the
/// cells' buffer, no images.
class ExposureStage {
public:
    struct Images {
        const Surface& radiance;
        const Surface& depth;
        const cl::Buffer& outExposure;
    };
    explicit ExposureStage(const Device& device);
    void enqueue(const Images& images, const ExposureParams& params);

private:
    Kernel luminanceSum_;
    Kernel exposure_;
    cl::Buffer cells_;
};

}  // namespace earthshine
