#include "stages/exposure_stage.hpp"

namespace earthshine {

ExposureStage::ExposureStage(const Device& device)
    : luminanceSum_(device, "luminance_sum"),
      exposure_(device, "exposure"),
      cells_(device.impl().makeBuffer(sizeof(cl_float2) * LUMINANCE_CELLS_X * LUMINANCE_CELLS_Y)) {}

void ExposureStage::enqueue(const Images& images, const ExposureParams& params) {
    requireExtent("luminance_sum", "inDepth", images.depth, images.radiance.extent());
    if (params.automatic) {
        luminanceSum_.set("inRadiance", images.radiance).set("inDepth", images.depth).set("outCells", cells_);
        luminanceSum_.enqueueItems(LUMINANCE_CELLS_X, LUMINANCE_CELLS_Y);
    }
    exposure_.set("cells", cells_).set("outExposure", images.outExposure).setParams("params", params);
    exposure_.enqueueItems(1, 1);
}

}  // namespace earthshine
