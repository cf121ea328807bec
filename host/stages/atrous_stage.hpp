#pragma once
// One pass of the edge-avoiding a-trous filter: the host half of kernels/atrous.cl.

#include "atrous_params.h"
#include "compute/kernel.hpp"

namespace earthshine {

/// Filters irradiance over taps of the same surface. Thread-compatible; owns its program, no images.
class AtrousStage {
public:
    struct Images {
        const Surface& irradiance;
        const Surface& normalWs;
        const Surface& depth;
        const Surface& length;  ///< frames of history
        const Surface& moment;  ///< read only if luminanceTolerance > 0
        const Surface& outIrradiance;
    };
    explicit AtrousStage(const Device& device) : kernel_(device, "atrous") {}
    /// Throws DeviceError if the taps reach farther than a surface's guard.
    void enqueue(const Images& images, const AtrousParams& params);

private:
    Kernel kernel_;
};

}  // namespace earthshine
