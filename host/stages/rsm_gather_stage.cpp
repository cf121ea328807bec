#include "stages/rsm_gather_stage.hpp"

namespace earthshine {

void RsmGatherStage::set(Kernel& kernel, const char* name, const Device& device, const Images& images,
                         const RsmGatherParams& params) {
    const Extent extent = images.outIrradiance.extent();
    requireExtent(name, "inNormalWs", images.normalWs, extent);
    requireExtent(name, "inDepth", images.depth, extent);
    kernel.define("MAPPING", params.mapping).define("ROTATION", params.rotation);
    kernel.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    setRsm(kernel, device, images.rsm);
    kernel.set("lights", images.lights).set("pattern", images.pattern).set("noise", images.noise);
    kernel.set("outIrradiance", images.outIrradiance).setParams("params", params);
}

void RsmGatherStage::enqueue(const Images& images, const RsmGatherParams& params) {
    set(kernel_, "rsm_gather", device_, images, params);
    kernel_.enqueue(images.outIrradiance.extent());
}

}  // namespace earthshine
