#include "stages/interpolate_stage.hpp"

#include "stages/pick_grid.hpp"

namespace earthshine {

void InterpolateStage::enqueue(const Images& images, const ViewRays& cameraRays, int stride,
                               const Suitability& suitability) {
    const Extent full = images.outIrradiance.extent(), picked = pickedExtent(full, stride);
    requireExtent("interpolate", "inNormalWs", images.normalWs, full);
    requireExtent("interpolate", "inDepth", images.depth, full);
    requireExtent("interpolate", "lowNormalWs", images.lowNormalWs, picked);
    requireExtent("interpolate", "lowDepth", images.lowDepth, picked);
    requireExtent("interpolate", "lowIrradiance", images.lowIrradiance, picked);
    Device::Impl& impl = device_.impl();
    impl.checked("interpolate: clearing the count",
                 [&] { return impl.queue.enqueueFillBuffer(images.outCount, i32(0), 0, sizeof(i32)); });
    const InterpolateParams params{
        cameraRays, makePickGrid(full, stride), suitability.minCosine, suitability.maxPlaneTexels, 0, 0};
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    kernel_.set("lowNormalWs", images.lowNormalWs).set("lowDepth", images.lowDepth);
    kernel_.set("lowIrradiance", images.lowIrradiance).set("outIrradiance", images.outIrradiance);
    kernel_.set("outPixels", images.outPixels).set("outCount", images.outCount);
    kernel_.setParams("params", params);
    kernel_.enqueue(full);
}

}  // namespace earthshine
