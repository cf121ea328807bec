#include "interop/frame_surfaces.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "earthshine/error.hpp"
#include "stages/frame_params.hpp"

namespace earthshine {

namespace {

// The maps of all lights stand below one another: in an image, whose height devices limit, or in planes and records,
// which kernels reach with 32-bit byte offsets.
void checkAtlas(const Device& device, const char* what, Extent map, int mapCount) {
    const DeviceCaps& caps = device.caps();
    const auto rows = std::int64_t(map.heightPx) * mapCount;
    if (device.tuning().storage == Storage::Image &&
        (rows > std::int64_t(caps.maxImageSizePx[1]) || map.widthPx > std::int64_t(caps.maxImageSizePx[0])))
        throw DeviceError(
            fmt::format("{} {} of {} x {} are more than an image of \"{}\" holds ({} rows); make them smaller, or use "
                        "planar storage",
                        mapCount, what, map.widthPx, map.heightPx, caps.name, caps.maxImageSizePx[1]));
    constexpr std::int64_t kMaxTexels = (std::int64_t(1) << 32) / std::int64_t(sizeof(RsmRecord));
    if (rows * map.widthPx >= kMaxTexels)
        throw DeviceError(
            fmt::format("{} {} of {} x {} are more than the {} texels that kernels can address; make them smaller",
                        mapCount, what, map.widthPx, map.heightPx, kMaxTexels));
}

}  // namespace

void prepareSurfaces(const Device& device, const FrameShape& shape, const std::vector<Light>& lights,
                     FrameSurfaces& out) {
    const int lightCount = int(lights.size());
    const int mapCount = lightCount > 0 ? lightCount : 1;  // without a light, one texel that nobody reads
    const Extent rsm = lightCount > 0 ? shape.rsm : Extent{1, 1};
    const Extent shadow = lightCount > 0 ? shape.shadow : Extent{1, 1};
    checkAtlas(device, "shadow maps", shadow, mapCount);
    checkAtlas(device, "RSMs", rsm, mapCount);

    std::vector<LightParams> params;
    for (const Light& light : lights) params.push_back(makeLightParams(light, rsm, shadow));
    params.resize(std::size_t(mapCount));
    out.lights = device.impl().upload(params);

    ensure(device, out.albedo, PixelFormat::RGBA16F, shape.extent);
    ensure(device, out.normalWs, PixelFormat::RGBA16F, shape.extent);
    ensure(device, out.depth, PixelFormat::R32F, shape.extent);
    const auto ensureOptional = [&](bool isThere, Surface& surface) {
        if (isThere)
            ensure(device, surface, PixelFormat::RGBA16F, shape.extent);
        else
            surface = {};
    };
    ensureOptional(shape.hasEmission, out.emission);
    ensureOptional(shape.hasMotion, out.motion);

    const Extent rsmAtlas{rsm.widthPx, rsm.heightPx * mapCount};
    ensure(device, out.rsm.depth, PixelFormat::R32F, rsmAtlas);
    ensure(device, out.rsm.normalWs, PixelFormat::RGBA16F, rsmAtlas);
    ensure(device, out.rsm.flux, PixelFormat::RGBA32F, rsmAtlas);
    ensure(device, out.shadowDepth, PixelFormat::R32F, {shadow.widthPx, shadow.heightPx * mapCount});
    out.shadowExtent = shadow;
    if (device.tuning().rsmRecords &&
        (out.rsm.sizePx != rsm.widthPx || out.rsm.lightCount != lightCount || !out.rsm.records()))
        out.rsm.records = device.impl().makeBuffer(sizeof(RsmRecord) * std::size_t(rsmAtlas.widthPx) *
                                                   std::size_t(rsmAtlas.heightPx));
    out.rsm.sizePx = rsm.widthPx;
    out.rsm.lightCount = lightCount;
}

}  // namespace earthshine
