#include "stages/tile_average_stage.hpp"

namespace earthshine {

void TileAverageStage::enqueue(const Images& images, const TileAverageParams& params) {
    const Extent extent = images.outIrradiance.extent();
    requireExtent("tile_average", "inIrradiance", images.irradiance, extent);
    requireExtent("tile_average", "inNormalWs", images.normalWs, extent);
    requireExtent("tile_average", "inDepth", images.depth, extent);
    kernel_.set("inIrradiance", images.irradiance).set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    kernel_.set("outIrradiance", images.outIrradiance).setParams("params", params);
    kernel_.enqueue(extent);
}

}  // namespace earthshine
