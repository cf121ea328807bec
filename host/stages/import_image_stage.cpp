#include "stages/import_image_stage.hpp"

namespace earthshine {

void ImportImageStage::enqueue(const cl::Image2D& image, const Surface& outSurface) {
    const int channels = outSurface.format() == PixelFormat::R32F ? 1 : 3;
    kernel_.set("image", image).set("outSurface", outSurface).setParams("channelCount", channels);
    kernel_.enqueue(outSurface.extent());
}

}  // namespace earthshine
