#include "stages/history_check_stage.hpp"

namespace earthshine {

void HistoryCheckStage::enqueue(const Images& images, HistoryCheckParams params) {
    const Extent extent = images.change.extent(), count = tiles(extent);
    const auto columns = std::size_t(count.widthPx), rows = std::size_t(count.heightPx);
    if (extent_ != extent) {
        sums_ = device_.impl().makeBuffer(2 * sizeof(float) * columns * rows);
        extent_ = extent;
    }
    check_.set("inChange", images.change).set("outSums", sums_);
    check_.enqueue({extent.widthPx, count.heightPx});
    params.columns = count.widthPx;
    params.rows = count.heightPx;
    confidence_.set("inSums", sums_).set("outConfidence", images.outConfidence).setParams("params", params);
    confidence_.enqueueItems(columns, rows);
}

}  // namespace earthshine
