#include "stages/interleave_stage.hpp"

namespace earthshine {

void InterleaveStage::enqueue(const Images& images, const cl::Buffer& outPixels) {
    requireExtent("interleave", "inDepth", images.depth, images.color.extent());
    kernel_.set("inColor", images.color).set("inDepth", images.depth).set("outPixels", outPixels);
    kernel_.enqueue(images.color.extent());
}

}  // namespace earthshine
