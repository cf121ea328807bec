#include "stages/rsm_sum_stage.hpp"

namespace earthshine {

void RsmSumStage::enqueue(const Images& images, const RsmSumParams& params, int rowCount) {
    const Extent extent = images.outIrradiance.extent();
    requireExtent("rsm_sum", "inNormalWs", images.normalWs, extent);
    requireExtent("rsm_sum", "inDepth", images.depth, extent);
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    setRsm(kernel_, device_, images.rsm);
    kernel_.set("lights", images.lights).set("outIrradiance", images.outIrradiance).setParams("params", params);
    kernel_.enqueue({images.outIrradiance.extent().widthPx, rowCount});
}

}  // namespace earthshine
