#include "stages/history_check_stage.hpp"

namespace earthshine {

void HistoryCheckStage::enqueue(const Images& images, HistoryCheckParams params) {
    const Extent extent = images.change.extent(), count = tiles(extent);
    const auto columns = std::size_t(count.widthPx), rowsPx = std::size_t(extent.heightPx);
    if (extent_ != extent) {
        sums_ = device_.impl().makeBuffer(2 * sizeof(float) * columns * rowsPx);
        extent_ = extent;
    }
    check_.set("inChange", images.change).set("outSums", sums_);
    check_.enqueueItems(columns, rowsPx);
    params.columns = count.widthPx;
    params.heightPx = extent.heightPx;
    confidence_.set("inSums", sums_).set("outConfidence", images.outConfidence).setParams("params", params);
    confidence_.enqueueItems(columns, std::size_t(count.heightPx));
}

}  // namespace earthshine
