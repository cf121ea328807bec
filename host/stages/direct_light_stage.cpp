#include "stages/direct_light_stage.hpp"

namespace earthshine {

void DirectLightStage::enqueue(const Images& images, const DirectLightParams& params) {
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth).set("shadowDepth", images.shadowDepth);
    kernel_.set("lights", images.lights).set("outIrradiance", images.outIrradiance).setParams("params", params);
    kernel_.enqueue(images.outIrradiance.extent());
}

}  // namespace earthshine
