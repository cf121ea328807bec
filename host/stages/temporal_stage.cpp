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
    requireExtent("temporal", "outLength", images.outLength, extent);
    requireExtent("temporal", "outChange", images.outChange, extent);
    params.hasMotion = images.motion ? 1 : 0;
    params.keepsMoment = images.outMoment.empty() ? 0 : 1;
    if (params.keepsMoment) {
        requireExtent("temporal", "historyMoment", images.history.moment, extent);
        requireExtent("temporal", "outMoment", images.outMoment, extent);
    }
    kernel_.set("inIrradiance", images.irradiance).set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    // What is not there is bound all the same, and not read or written.
    kernel_.set("inMotion", images.motion ? *images.motion : images.normalWs);
    kernel_.set("prevNormalWs", images.prevNormalWs).set("prevDepth", images.prevDepth);
    kernel_.set("historyIrradiance", images.history.irradiance).set("historyLength", images.history.length);
    kernel_.set("historyMoment", params.keepsMoment ? images.history.moment : images.history.length)
        .set("confidence", images.confidence);
    kernel_.set("outIrradiance", images.outIrradiance).set("outLength", images.outLength);
    kernel_.set("outMoment", params.keepsMoment ? images.outMoment : images.outLength);
    kernel_.set("outChange", images.outChange).setParams("params", params);
    kernel_.enqueue(extent);
}

}  // namespace earthshine
