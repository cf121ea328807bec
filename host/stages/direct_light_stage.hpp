#pragma once
// Direct light behind hard shadow maps: the host half of kernels/direct_light.cl.

#include "compute/kernel.hpp"
#include "direct_light_params.h"

namespace earthshine {

/// Computes direct irradiance (lx) of all lights. Thread-compatible; owns its program, no images.
class DirectLightStage {
public:
    struct Images {
        const Surface& normalWs;
        const Surface& depth;
        const Surface& shadowDepth;  ///< all lights' maps below one another
        const cl::Buffer& lights;    ///< LightParams
        const Surface& outIrradiance;
    };
    explicit DirectLightStage(const Device& device) : kernel_(device, "direct_light") {}
    void enqueue(const Images& images, const DirectLightParams& params);

private:
    Kernel kernel_;
};

}  // namespace earthshine
