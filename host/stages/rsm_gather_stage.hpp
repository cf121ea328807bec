#pragma once
// One bounce from a few texels a pixel: the host half of kernels/rsm_gather.cl.

#include "rsm_gather_params.h"
#include "stages/rsm_view.hpp"

namespace earthshine {

/// Estimates one-bounce irradiance (lx) from a disk of each light's RSM. Thread-compatible; owns its program, no
/// images.
class RsmGatherStage {
public:
    struct Images {
        const Surface& normalWs;
        const Surface& depth;
        const RsmView& rsm;
        const cl::Buffer& lights;   ///< LightParams, one a map
        const cl::Buffer& pattern;  ///< f32x4, sampleCount of them (makeDiskPattern)
        const cl::Buffer& noise;    ///< makeRotationNoise
        const Surface& outIrradiance;
    };
    explicit RsmGatherStage(const Device& device) : device_(device), kernel_(device, "rsm_gather") {}
    void enqueue(const Images& images, const RsmGatherParams& params);

    /// Every argument that `rsm_gather` and `rsm_gather_list` share, for `kernel`, either of them; `name` is for
    /// errors.
    static void set(Kernel& kernel, const char* name, const Device& device, const Images& images,
                    const RsmGatherParams& params);

private:
    Device device_;
    Kernel kernel_;
};

}  // namespace earthshine
