#include "pipeline/make_params.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stages/frame_params.hpp"
#include "stages/rsm_minify_stage.hpp"

namespace earthshine {

FrameParams makeParams(const Settings& settings, const FrameGeometry& frame) {
    constexpr float kMiddleGrey = 0.18f;  // what photographers and displays take for the middle
    FrameParams p;
    p.estimator = settings.estimator;
    p.pattern = settings.pattern;
    const int frameIndex = settings.animatesNoise ? frame.frameIndex : 0;
    const int mapSizePx = minifiedSizePx(frame.rsmSizePx, settings.rsmMinify);
    p.pack = {frame.rsmSizePx, frame.lightCount, settings.rsmMinify, u32(frameIndex)};
    p.gather.cameraRays = frame.cameraRays;
    p.gather.rsmSizePx = mapSizePx;
    p.gather.mapScale = float(frame.rsmSizePx) / float(std::max(mapSizePx * settings.rsmMinify, 1));
    p.gather.lightCount = frame.lightCount;
    p.gather.sampleCount = settings.sampleCount;
    p.gather.radiusUv = settings.radiusUv;
    p.gather.rotates = settings.rotates ? 1 : 0;
    p.gather.mapping = settings.mapping == RadiusMapping::Area    ? MAPPING_AREA
                       : settings.mapping == RadiusMapping::Polar ? MAPPING_POLAR
                                                                  : MAPPING_SQUARED;
    const FrameMove move = makeFrameMove(frameIndex, settings.sampleCount);
    p.gather.frameShift = float(move.shift);
    p.gather.frameTurnCos = float(std::cos(2.0 * std::numbers::pi * move.turn));
    p.gather.frameTurnSin = float(std::sin(2.0 * std::numbers::pi * move.turn));
    p.sum.cameraRays = frame.cameraRays;
    p.sum.rsmSizePx = mapSizePx;
    p.sum.lightCount = frame.lightCount;
    p.directLight.cameraRays = frame.cameraRays;
    p.directLight.lightCount = frame.lightCount;
    p.directLight.shadowWidthPx = frame.shadowExtent.widthPx;
    p.directLight.shadowHeightPx = frame.shadowExtent.heightPx;
    p.directLight.shadowBiasTexels = settings.shadowBiasTexels;
    p.directLight.shadowSlopeBiasTexels = settings.shadowSlopeBiasTexels;
    p.exposure.automatic = settings.autoExposure ? 1 : 0;
    p.exposure.stops = settings.exposureStops;
    p.exposure.middleGrey = kMiddleGrey;
    p.toneMap.curve = settings.toneCurve == ToneCurve::Filmic ? TONE_CURVE_FILMIC : TONE_CURVE_SRGB;
    return p;
}

}  // namespace earthshine
