#include "stages/rsm_gather_stage.hpp"

namespace earthshine {

void RsmGatherStage::enqueue(const Images& images, const RsmGatherParams& params) {
    const Extent extent = images.outIrradiance.extent();
    requireExtent("rsm_gather", "inNormalWs", images.normalWs, extent);
    requireExtent("rsm_gather", "inDepth", images.depth, extent);
    kernel_.define("MAPPING", params.mapping).define("ROTATION", params.rotation);
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    setRsm(kernel_, device_, images.rsm);
    kernel_.set("lights", images.lights)
        .set("pattern", images.pattern)
        .set("noise", images.noise)
        .set("outIrradiance", images.outIrradiance);
    kernel_.setParams("params", params);
    kernel_.enqueue(images.outIrradiance.extent());
}

}  // namespace earthshine
