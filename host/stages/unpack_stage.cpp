#include "stages/unpack_stage.hpp"

namespace earthshine {

void UnpackStage::enqueue(const cl::Buffer& pixels, PixelFormat format, Extent extent, const Surface& outSurface,
                          int firstRowPx) {
    UnpackParams params{};
    params.format = format == PixelFormat::R32F      ? UNPACK_R32F
                    : format == PixelFormat::RGBA16F ? UNPACK_RGBA16F
                                                     : UNPACK_RGBA32F;
    params.firstRowPx = firstRowPx;
    params.widthPx = extent.widthPx;
    params.heightPx = extent.heightPx;
    kernel_.set("pixels", pixels).set("outSurface", outSurface).setParams("params", params);
    kernel_.enqueue(extent);
}

}  // namespace earthshine
