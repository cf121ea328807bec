#pragma once
// Does history still fit what arrives? The host half of kernels/history_check.cl and
// history_confidence.cl.

#include "compute/kernel.hpp"
#include "history_check_params.h"

namespace earthshine {

/// Writes one confidence a tile. Thread-compatible; owns its programs and the sums, no images.
class HistoryCheckStage {
public:
    struct Images {
        const Surface& change;  ///< temporal's
        const cl::Buffer& outConfidence;
    };
    explicit HistoryCheckStage(const Device& device)
        : device_(device), check_(device, "history_check"), confidence_(device, "history_confidence") {}
    /// `params.columns` and `rows` are set from `images`.
    void enqueue(const Images& images, HistoryCheckParams params);

    /// Tiles in x and y of a picture.
    static Extent tiles(Extent extent) {
        return {(extent.widthPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX,
                (extent.heightPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX};
    }

private:
    Device device_;
    Kernel check_, confidence_;
    Extent extent_;
    cl::Buffer sums_;
};

}  // namespace earthshine
