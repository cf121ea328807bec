#include "stages/rsm_pack_stage.hpp"

namespace earthshine {

void RsmPackStage::enqueue(const RsmView& rsm, const cl::Buffer& lights) {
    requireExtent("rsm_pack", "inDepth", rsm.depth, {rsm.sizePx, rsm.sizePx * rsm.lightCount});
    requireExtent("rsm_pack", "inNormalWs", rsm.normalWs, rsm.depth.extent());
    requireExtent("rsm_pack", "inFlux", rsm.flux, rsm.depth.extent());
    const RsmPackParams params{rsm.sizePx, rsm.lightCount, 1, 0};
    kernel_.set("inDepth", rsm.depth).set("inNormalWs", rsm.normalWs).set("inFlux", rsm.flux);
    kernel_.set("lights", lights).set("outRecords", rsm.records).setParams("params", params);
    kernel_.enqueue({rsm.sizePx, rsm.sizePx * rsm.lightCount});
}

}  // namespace earthshine
