#include "room.hpp"

#include <algorithm>
#include <cstdint>

#include "interop/host_transport.hpp"
#include "room_frame.hpp"
#include "run_options.hpp"
#include "stages/frame_params.hpp"

namespace earthshine::bench {

namespace {

void fill(const Device& device, const HostImage& image, const Surface& surface) {
    HostTransport transport(device);
    transport.enqueueImage(image.view(), surface, 0);
    device.impl().finish();
}

FrameSurfaces bring(const Device& device, const FrameInputs& frame) {
    FrameSurfaces surfaces;
    HostTransport transport(device);
    transport.enqueue(frame, surfaces);
    device.impl().finish();
    return surfaces;
}

// The same everywhere, along surfaces: to the depth that was there.
HostImage constantMotion(const HostImage& depth) {
    const Extent extent = depth.extent();
    HostImage motion(PixelFormat::RGBA32F, extent);
    for (int y = 0; y < extent.heightPx; ++y)
        for (int x = 0; x < extent.widthPx; ++x) {
            motion.pixel(x, y)[0] = 1.3f;
            motion.pixel(x, y)[1] = 0.6f;
            const int thenX = std::min(x + 1, extent.widthPx - 1), thenY = std::min(y + 1, extent.heightPx - 1);
            motion.pixel(x, y)[2] = *depth.pixel(thenX, thenY) - *depth.pixel(x, y);
        }
    return toHalf(motion.view());
}

}  // namespace

Room::Room(const Variant& variant, Extent size, bool moves, int rsmSizePx)
    : device(runOptions().device, variant.options), extent(size), pixels(double(size.widthPx) * size.heightPx) {
    const FrameImages& images = roomFrame(extent, rsmSizePx);
    FrameInputs frame = images.inputs();
    const HostImage motion = moves ? constantMotion(images.depth) : HostImage();
    if (moves) frame.gbuffer.motion = motion.view();
    inputs = bring(device, frame);
    rays = makeViewRays(frame.camera, extent);
    for (int y = 0; y < extent.heightPx; ++y)
        for (int x = 0; x < extent.widthPx; ++x) seenPixels += *images.depth.pixel(x, y) > 0.0f ? 1.0 : 0.0;
}

FrameSurfaces Room::another() const {
    return bring(device, roomFrame(extent, inputs.rsm.sizePx).inputs());
}

Surface Room::noisy() const {
    HostImage image(PixelFormat::RGBA32F, extent);
    std::uint32_t state = 1;
    for (int y = 0; y < extent.heightPx; ++y)
        for (int x = 0; x < extent.widthPx; ++x) {
            state = state * 1664525u + 1013904223u;
            for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = 100.0f + float(state >> 8) * (400.0f / 16777216.0f);
        }
    const Surface surface = three();
    fill(device, image, surface);
    return surface;
}

Surface Room::constant(float value) const {
    HostImage image(PixelFormat::R32F, extent);
    for (int y = 0; y < extent.heightPx; ++y)
        for (int x = 0; x < extent.widthPx; ++x) *image.pixel(x, y) = value;
    const Surface surface = one();
    fill(device, image, surface);
    return surface;
}

FrameParams Room::params(const Settings& settings, bool hasHistory) const {
    FrameGeometry geometry{rays, extent, inputs.rsm.sizePx, 1, inputs.shadowExtent};
    geometry.previousRays = rays;
    geometry.hasHistory = geometry.hasConfidence = hasHistory;
    return makeParams(settings, geometry);
}

double Room::bytes(std::initializer_list<Surface> whole, std::initializer_list<Surface> seen) const {
    double all = 0.0, some = 0.0;
    for (const Surface& surface : whole) all += double(surface.sizeBytes());
    for (const Surface& surface : seen) some += double(surface.sizeBytes());
    return all + some * seenPixels / pixels;
}

double Room::rsmBytes(double samples) const {
    const RsmView& rsm = inputs.rsm;
    const double texels = double(rsm.sizePx) * rsm.sizePx * rsm.lightCount;
    const double all = device.tuning().rsmRecords
                           ? sizeof(RsmRecord) * texels
                           : double(rsm.depth.sizeBytes() + rsm.normalWs.sizeBytes() + rsm.flux.sizeBytes());
    return all * std::min(samples / texels, 1.0);
}

}  // namespace earthshine::bench
