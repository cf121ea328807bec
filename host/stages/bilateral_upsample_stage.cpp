#include "stages/bilateral_upsample_stage.hpp"

#include "stages/pick_grid.hpp"

namespace earthshine {

void BilateralUpsampleStage::enqueue(const Images& images, const ViewRays& cameraRays, int stride) {
    const Extent full = images.outIrradiance.extent(), picked = pickedExtent(full, stride);
    requireExtent("bilateral_upsample", "inNormalWs", images.normalWs, full);
    requireExtent("bilateral_upsample", "inDepth", images.depth, full);
    requireExtent("bilateral_upsample", "lowNormalWs", images.lowNormalWs, picked);
    requireExtent("bilateral_upsample", "lowDepth", images.lowDepth, picked);
    requireExtent("bilateral_upsample", "lowIrradiance", images.lowIrradiance, picked);
    const BilateralUpsampleParams params{cameraRays, makePickGrid(full, stride)};
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    kernel_.set("lowNormalWs", images.lowNormalWs).set("lowDepth", images.lowDepth);
    kernel_.set("lowIrradiance", images.lowIrradiance).set("outIrradiance", images.outIrradiance);
    kernel_.setParams("params", params);
    kernel_.enqueue(full);
}

}  // namespace earthshine
