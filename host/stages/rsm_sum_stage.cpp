#include "stages/rsm_sum_stage.hpp"

namespace earthshine {

void RsmSumStage::enqueue(const Images& images, const RsmSumParams& params, int rowCount) {
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    setRsm(kernel_, device_, images.rsm);
    kernel_.set("lights", images.lights).set("outIrradiance", images.outIrradiance).setParams("params", params);
    kernel_.enqueue({images.outIrradiance.extent().widthPx, rowCount});
}

}  // namespace earthshine
