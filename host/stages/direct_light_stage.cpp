#include "stages/direct_light_stage.hpp"

namespace earthshine {

void DirectLightStage::enqueue(const Images& images, const DirectLightParams& params) {
    const Extent extent = images.outIrradiance.extent();
    requireExtent("direct_light", "inNormalWs", images.normalWs, extent);
    requireExtent("direct_light", "inDepth", images.depth, extent);
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth).set("shadowDepth", images.shadowDepth);
    kernel_.set("lights", images.lights).set("outIrradiance", images.outIrradiance).setParams("params", params);
    kernel_.enqueue(images.outIrradiance.extent());
}

}  // namespace earthshine
