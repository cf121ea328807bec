#include "stages/history_check_stage.hpp"

namespace earthshine {

void HistoryCheckStage::enqueue(const Images& images, const HistoryCheckParams& params) {
    requireExtent("history_check", "inAccumulated", images.accumulated, images.irradiance.extent());
    kernel_.set("inIrradiance", images.irradiance).set("inAccumulated", images.accumulated);
    kernel_.set("outConfidence", images.outConfidence).setParams("params", params);
    const Extent count = tiles(images.irradiance.extent());
    kernel_.enqueueItems(std::size_t(count.widthPx), std::size_t(count.heightPx));
}

}  // namespace earthshine
