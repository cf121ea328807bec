#include "stages/unpack_stage.hpp"

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine {

void UnpackStage::enqueue(const cl::Buffer& pixels, PixelFormat format, Extent extent, const Surface& outSurface,
                          int firstRowPx) {
    const Extent room{outSurface.extent().widthPx, outSurface.extent().heightPx - firstRowPx};
    if (format == PixelFormat::RGBA8 || extent.widthPx != room.widthPx || extent.heightPx > room.heightPx ||
        firstRowPx < 0)
        throw DeviceError(fmt::format("unpack: {} pixels of {} x {} do not go into row {} of a surface of {} x {}",
                                      formatName(format), extent.widthPx, extent.heightPx, firstRowPx,
                                      outSurface.extent().widthPx, outSurface.extent().heightPx));
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
