#include "stages/atrous_stage.hpp"

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine {

void AtrousStage::set(Kernel& kernel, const Images& images, const AtrousParams& params) {
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
    kernel.set("inIrradiance", images.irradiance).set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    kernel.set("inLength", images.length);
    kernel.set("outIrradiance", images.outIrradiance).setParams("params", params);
}

void AtrousStage::enqueue(const Images& images, const AtrousParams& params) {
    set(kernel_, images, params);
    kernel_.set("inMoment", params.luminanceTolerance > 0.0f ? images.moment : images.length);  // else bound, not read
    kernel_.enqueue(images.outIrradiance.extent());
}

void AtrousStage::enqueuePair(const Images& images, const AtrousParams& params) {
    if (!canPair(params))
        throw DeviceError("atrous: a pair has weights of planes and no luminance; use a launch a pass");
    set(pair_, images, params);
    const Extent extent = images.outIrradiance.extent();
    const int widthPx = ATROUS_PAIR_STRIP(lanes_) * lanes_, heightPx = ATROUS_PAIR_ROWS(lanes_) * params.stepPx;
    pair_.enqueueItems(std::size_t((extent.widthPx + widthPx - 1) / widthPx),
                       std::size_t((extent.heightPx + heightPx - 1) / heightPx * params.stepPx));
}

}  // namespace earthshine
