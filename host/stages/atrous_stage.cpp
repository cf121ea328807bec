#include "stages/atrous_stage.hpp"

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine {

void AtrousStage::enqueue(const Images& images, const AtrousParams& params) {
    constexpr int kMaxLanes = 16, kMaxRadius = 2;
    const Extent extent = images.outIrradiance.extent();
    requireExtent("atrous", "inIrradiance", images.irradiance, extent);
    requireExtent("atrous", "inNormalWs", images.normalWs, extent);
    requireExtent("atrous", "inDepth", images.depth, extent);
    requireExtent("atrous", "inLength", images.length, extent);
    if (params.luminanceTolerance > 0.0f) requireExtent("atrous", "inMoment", images.moment, extent);
    if (params.stepPx < 1 || kMaxRadius * params.stepPx > SURFACE_GUARD - kMaxLanes)
        throw DeviceError(fmt::format("atrous: a step of {} px is not in [1; {}]", params.stepPx,
                                      (SURFACE_GUARD - kMaxLanes) / kMaxRadius));
    kernel_.set("inIrradiance", images.irradiance).set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    kernel_.set("inLength", images.length);
    kernel_.set("inMoment", params.luminanceTolerance > 0.0f ? images.moment : images.length);  // else bound, not read
    kernel_.set("outIrradiance", images.outIrradiance).setParams("params", params);
    kernel_.enqueue(extent);
}

}  // namespace earthshine
