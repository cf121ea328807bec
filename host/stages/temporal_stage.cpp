#include "stages/temporal_stage.hpp"

namespace earthshine {

void TemporalStage::enqueue(const Images& images, TemporalParams params) {
    const Extent extent = images.outIrradiance.extent();
    requireExtent("temporal", "inIrradiance", images.irradiance, extent);
    requireExtent("temporal", "inNormalWs", images.normalWs, extent);
    requireExtent("temporal", "inDepth", images.depth, extent);
    if (images.motion) requireExtent("temporal", "inMotion", *images.motion, extent);
    requireExtent("temporal", "prevNormalWs", images.prevNormalWs, extent);
    requireExtent("temporal", "prevDepth", images.prevDepth, extent);
    requireExtent("temporal", "historyIrradiance", images.history.irradiance, extent);
    requireExtent("temporal", "historyLength", images.history.length, extent);
    requireExtent("temporal", "historyMoment", images.history.moment, extent);
    requireExtent("temporal", "outLength", images.outLength, extent);
    requireExtent("temporal", "outMoment", images.outMoment, extent);
    params.hasMotion = images.motion ? 1 : 0;
    kernel_.set("inIrradiance", images.irradiance).set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    kernel_.set("inMotion", images.motion ? *images.motion : images.normalWs);  // bound, but not read, if null
    kernel_.set("prevNormalWs", images.prevNormalWs).set("prevDepth", images.prevDepth);
    kernel_.set("historyIrradiance", images.history.irradiance).set("historyLength", images.history.length);
    kernel_.set("historyMoment", images.history.moment).set("confidence", images.confidence);
    kernel_.set("outIrradiance", images.outIrradiance).set("outLength", images.outLength);
    kernel_.set("outMoment", images.outMoment).setParams("params", params);
    kernel_.enqueue(extent);
}

}  // namespace earthshine
