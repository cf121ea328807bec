#pragma once
// The mean over the pixels that share a pattern's turns: the host half of kernels/tile_average.cl.

#include "compute/kernel.hpp"
#include "tile_average_params.h"

namespace earthshine {

/// Averages irradiance over 4 x 4 pixels of one surface. Thread-compatible; owns its program, no images.
class TileAverageStage {
public:
    struct Images {
        const Surface& irradiance;  ///< of a gather with ROTATION_TILE
        const Surface& normalWs;
        const Surface& depth;
        const Surface& outIrradiance;
    };
    explicit TileAverageStage(const Device& device) : kernel_(device, "tile_average") {}
    void enqueue(const Images& images, const TileAverageParams& params);

private:
    Kernel kernel_;
};

}  // namespace earthshine
