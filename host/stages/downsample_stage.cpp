#include "stages/downsample_stage.hpp"

#include "stages/pick_grid.hpp"

namespace earthshine {

void DownsampleStage::enqueue(const Images& images, int stride) {
    const Extent full = images.depth.extent(), picked = pickedExtent(full, stride);
    requireExtent("downsample", "inNormalWs", images.normalWs, full);
    requireExtent("downsample", "outNormalWs", images.outNormalWs, picked);
    requireExtent("downsample", "outDepth", images.outDepth, picked);
    const bool picksMotion = images.motion != nullptr && images.outMotion != nullptr;
    if (picksMotion) {
        requireExtent("downsample", "inMotion", *images.motion, full);
        requireExtent("downsample", "outMotion", *images.outMotion, picked);
    }
    const DownsampleParams params{makePickGrid(full, stride), picksMotion ? 1 : 0, 0, 0, 0};
    kernel_.set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    kernel_.set("inMotion", picksMotion ? *images.motion : images.normalWs);  // bound, but not touched, if null
    kernel_.set("outNormalWs", images.outNormalWs).set("outDepth", images.outDepth);
    kernel_.set("outMotion", picksMotion ? *images.outMotion : images.outNormalWs);
    kernel_.setParams("params", params);
    kernel_.enqueue(picked);
}

}  // namespace earthshine
