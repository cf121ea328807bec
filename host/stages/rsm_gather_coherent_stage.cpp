#include "stages/rsm_gather_coherent_stage.hpp"

namespace earthshine {

void RsmGatherCoherentStage::enqueue(const Images& images, const RsmChooseParams& params) {
    const Extent extent = images.outIrradiance.extent();
    requireExtent("rsm_gather_coherent", "inNormalWs", images.normalWs, extent);
    requireExtent("rsm_gather_coherent", "inDepth", images.depth, extent);
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    setRsm(kernel_, device_, images.rsm);
    kernel_.set("lights", images.lights).set("choices", images.choices).set("outIrradiance", images.outIrradiance);
    kernel_.setParams("params", params);
    // An item takes LANES pixels of each of the classes; one lane, one pixel.
    const int lanes = device_.tuning().lanes;
    const int pixels = lanes == 1 ? 1 : lanes * COHERENT_STRIDE_PX;
    kernel_.enqueueItems(std::size_t((extent.widthPx + pixels - 1) / pixels), std::size_t(params.rowCount));
}

}  // namespace earthshine
