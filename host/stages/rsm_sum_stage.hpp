#pragma once
// One bounce from every texel: the host half of kernels/rsm_sum.cl.

#include "rsm_sum_params.h"
#include "stages/rsm_view.hpp"

namespace earthshine {

/// Sums one-bounce irradiance (lx) over whole RSMs, a band of rows a launch. Thread-compatible; owns its program, no
/// images.
class RsmSumStage {
public:
    struct Images {
        const Surface& normalWs;
        const Surface& depth;
        const RsmView& rsm;
        const cl::Buffer& lights;  ///< LightParams, one a map
        const Surface& outIrradiance;
    };
    explicit RsmSumStage(const Device& device) : device_(device), kernel_(device, "rsm_sum") {}
    void enqueue(const Images& images, const RsmSumParams& params, int rowCount);

private:
    Device device_;
    Kernel kernel_;
};

}  // namespace earthshine
