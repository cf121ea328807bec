#pragma once
// One bounce from texels that pixels share: the host half of kernels/rsm_gather_coherent.cl.

#include "rsm_choose_params.h"
#include "stages/rsm_view.hpp"

namespace earthshine {

/// Estimates one-bounce irradiance (lx) of some rows from what RsmChooseStage chose for them. Thread-compatible; owns
/// its program, no images.
class RsmGatherCoherentStage {
public:
    struct Images {
        const Surface& normalWs;
        const Surface& depth;
        const RsmView& rsm;
        const cl::Buffer& lights;   ///< LightParams, one a map
        const cl::Buffer& choices;  ///< RsmChooseStage's, of the same rows
        const Surface& outIrradiance;
    };
    explicit RsmGatherCoherentStage(const Device& device) : device_(device), kernel_(device, "rsm_gather_coherent") {}
    void enqueue(const Images& images, const RsmChooseParams& params);

private:
    Device device_;
    Kernel kernel_;
};

}  // namespace earthshine
