#include "pipeline/lower_resolution.hpp"

#include <utility>

#include "stages/pick_grid.hpp"

namespace earthshine {

LowerResolution::LowerResolution(const Device& device)
    : device_(device), downsample_(device), upsample_(device), interpolate_(device), gatherList_(device) {}

void LowerResolution::pick(const FrameSurfaces& full, int divisor) {
    const Extent extent = pickedExtent(full.depth.extent(), divisor);
    std::swap(picked_.normalWs, previous_.normalWs);
    std::swap(picked_.depth, previous_.depth);
    ensure(device_, picked_.normalWs, PixelFormat::RGBA16F, extent);
    ensure(device_, picked_.depth, PixelFormat::R32F, extent);
    if (full.motion.empty())
        picked_.motion = {};
    else
        ensure(device_, picked_.motion, PixelFormat::RGBA16F, extent);
    picked_.rsm = full.rsm;
    picked_.lights = full.lights;
    const bool moves = !full.motion.empty();
    downsample_.enqueue({full.normalWs, full.depth, moves ? &full.motion : nullptr, picked_.normalWs, picked_.depth,
                         moves ? &picked_.motion : nullptr},
                        divisor);
}

void LowerResolution::allocate(Extent extent) {
    if (irradiance_.extent() == extent) return;
    irradiance_ = Surface(device_, PixelFormat::RGBA32F, extent);
    pixels_ = device_.impl().makeBuffer(sizeof(i32) * std::size_t(extent.widthPx) * std::size_t(extent.heightPx));
    count_ = device_.impl().makeBuffer(sizeof(i32));
}

const Surface& LowerResolution::upsample(const FrameSurfaces& full, const Surface& irradiance,
                                         const FrameParams& params) {
    allocate(full.depth.extent());
    upsample_.enqueue({full.normalWs, full.depth, picked_.normalWs, picked_.depth, irradiance, irradiance_},
                      params.fullRays, params.divisor);
    return irradiance_;
}

const Surface& LowerResolution::interpolate(const FrameSurfaces& full, const Surface& irradiance,
                                            const FrameParams& params, const cl::Buffer& pattern,
                                            const cl::Buffer& noise) {
    allocate(full.depth.extent());
    interpolate_.enqueue(
        {full.normalWs, full.depth, picked_.normalWs, picked_.depth, irradiance, irradiance_, pixels_, count_},
        params.fullRays, params.divisor);
    RsmGatherParams gather = params.gather;
    gather.cameraRays = params.fullRays;
    gatherList_.enqueue({full.normalWs, full.depth, full.rsm, full.lights, pattern, noise, irradiance_}, pixels_,
                        count_, gather);
    return irradiance_;
}

int LowerResolution::gatheredPixels() const {
    i32 count = 0;
    Device::Impl& impl = device_.impl();
    impl.checked("reading the count of gathered pixels",
                 [&] { return impl.queue.enqueueReadBuffer(count_, CL_TRUE, 0, sizeof count, &count); });
    return count;
}

}  // namespace earthshine
