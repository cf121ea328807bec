#include "stages/rsm_minify_stage.hpp"

namespace earthshine {

void RsmMinifyStage::enqueue(const RsmView& rsm, const cl::Buffer& lights, const RsmPackParams& params) {
    requireExtent("rsm_minify", "inDepth", rsm.depth, {params.sizePx, params.sizePx * params.lightCount});
    requireExtent("rsm_minify", "inNormalWs", rsm.normalWs, rsm.depth.extent());
    requireExtent("rsm_minify", "inFlux", rsm.flux, rsm.depth.extent());
    kernel_.set("inDepth", rsm.depth).set("inNormalWs", rsm.normalWs).set("inFlux", rsm.flux);
    kernel_.set("lights", lights).set("outRecords", rsm.records).setParams("params", params);
    const int sizePx = minifiedSizePx(params.sizePx, params.minify);
    kernel_.enqueue({sizePx, sizePx * params.lightCount});
}

}  // namespace earthshine
