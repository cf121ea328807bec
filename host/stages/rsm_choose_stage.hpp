#pragma once
// The texels that sets of pixels share: the host half of kernels/rsm_choose.cl.

#include "compute/kernel.hpp"
#include "rsm_choose_params.h"

namespace earthshine {

/// RsmChoices that a row of this many pixels has, of one light.
constexpr std::size_t choicesInRow(int widthPx, int sampleCount) {
    return std::size_t((widthPx + COHERENT_SPAN_PX - 1) / COHERENT_SPAN_PX * COHERENT_STRIDE_PX) *
           std::size_t(sampleCount);
}

/// Chooses RSM texels for each set of pixels of some rows. Thread-compatible; owns its program, no images.
class RsmChooseStage {
public:
    struct Images {
        const Surface& depth;
        const cl::Buffer& lights;      ///< LightParams, one a map
        const cl::Buffer& pattern;     ///< f32x4, sampleCount of them (makeDiskPattern)
        const cl::Buffer& noise;       ///< makeRotationNoise
        const cl::Buffer& outChoices;  ///< RsmChoice, choicesInRow of each row and light
    };
    explicit RsmChooseStage(const Device& device) : kernel_(device, "rsm_choose") {}
    void enqueue(const Images& images, const RsmChooseParams& params);

private:
    Kernel kernel_;
};

}  // namespace earthshine
