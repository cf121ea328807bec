#include "stages/rsm_gather_list_stage.hpp"

namespace earthshine {

void RsmGatherListStage::enqueue(const RsmGatherStage::Images& images, const cl::Buffer& pixels,
                                 const cl::Buffer& count, const RsmGatherParams& params) {
    const Extent extent = images.outIrradiance.extent();
    requireExtent("rsm_gather_list", "inNormalWs", images.normalWs, extent);
    requireExtent("rsm_gather_list", "inDepth", images.depth, extent);
    kernel_.define("MAPPING", params.mapping).define("ROTATION", params.rotation);
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    setRsm(kernel_, device_, images.rsm);
    kernel_.set("lights", images.lights).set("pattern", images.pattern).set("noise", images.noise);
    kernel_.set("pixels", pixels).set("count", count).set("outIrradiance", images.outIrradiance);
    kernel_.setParams("params", params);
    kernel_.enqueue(extent);
}

}  // namespace earthshine
