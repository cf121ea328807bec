#include "stages/history_check_stage.hpp"

namespace earthshine {

void HistoryCheckStage::enqueue(const Images& images, HistoryCheckParams params) {
    requireExtent("history_check", "inAccumulated", images.accumulated, images.irradiance.extent());
    const Extent count = tiles(images.irradiance.extent());
    const auto columns = std::size_t(count.widthPx), rows = std::size_t(count.heightPx);
    if (tiles_ != count) {
        sums_ = device_.impl().makeBuffer(2 * sizeof(float) * columns * rows);
        tiles_ = count;
    }
    check_.set("inIrradiance", images.irradiance).set("inAccumulated", images.accumulated).set("outSums", sums_);
    check_.enqueueItems(columns, rows);
    params.columns = count.widthPx;
    params.rows = count.heightPx;
    confidence_.set("inSums", sums_).set("outConfidence", images.outConfidence).setParams("params", params);
    confidence_.enqueueItems(columns, rows);
}

}  // namespace earthshine
