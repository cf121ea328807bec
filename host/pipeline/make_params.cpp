#include "pipeline/make_params.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "stages/frame_params.hpp"
#include "stages/pick_grid.hpp"
#include "stages/rsm_minify_stage.hpp"

namespace earthshine {

namespace {

float lengthOf(const f32x4& v) {
    return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// What the mean of a tile takes for one surface.
TileAverageParams tileAverageParams(const FrameGeometry& frame) {
    TileAverageParams p{};
    p.cameraRays = frame.cameraRays;
    p.minNormalCosine = 0.9f;  // 26 degrees
    p.planeTolerance = 0.5f;
    p.footprintM = lengthOf(frame.cameraRays.originDx);
    p.footprintPerM = lengthOf(frame.cameraRays.rayDx);
    return p;
}

TemporalParams temporalParams(const Settings& settings, const FrameGeometry& frame) {
    // How far off its plane a surface may be found again: depths of 32 bits and motion of 16 are that wrong, and curved
    // surfaces that flat, from one pixel to the next.
    constexpr float kPlaneTolerance = 0.01f;  // of the distance
    // Squared differences of normals: 26 degrees, coming in from 0 on; without weighing 37.
    constexpr float kWeighedNormalTolerance = 0.2f, kNormalTolerance = 0.4f;
    TemporalParams p{};
    p.previousRays = frame.previousRays;
    p.hasHistory = settings.accumulates && frame.hasHistory ? 1 : 0;
    p.usesConfidence = p.hasHistory != 0 && settings.antiLag > 0.0f && frame.hasConfidence ? 1 : 0;
    p.maxFrames = float(settings.historyFrames);
    p.planeTolerance = kPlaneTolerance;
    p.weighsTurn = settings.filterWeights == FilterWeights::Plane ? 1 : 0;
    p.inverseNormalTolerance = 1.0f / (p.weighsTurn ? kWeighedNormalTolerance : kNormalTolerance);
    p.fireflyFactor = settings.fireflyFactor;
    return p;
}

// What history an iteration's neighbours count in full up to.
float fadeFrames(const Settings& settings, int iteration) {
    constexpr float kNever = 1024.0f;  // the setting's largest
    if (settings.filterFade >= kNever) return kNever;
    // A step is twice as wide as the one before: it must fade twice as fast, or it blurs what frames made clean. From
    // four pixels on it crosses more edges of light than it finds noise as soon as there are some frames: four times as
    // fast again, but a first frame has at least half of it. (Eighth frame of an orbit of a game level: relMSE 0.018,
    // else 0.026.)
    const float frames = std::ldexp(settings.filterFade, iteration < 2 ? -iteration : -iteration - 2);
    return std::max(frames, 0.5f);
}

// The passes of all iterations in order: one each, or a row and a column.
std::vector<AtrousParams> filterPasses(const Settings& settings, const FrameGeometry& frame) {
    std::vector<AtrousParams> passes;
    for (int i = 0; i < settings.filterIterations; ++i) {
        AtrousParams p{};
        p.cameraRays = frame.cameraRays;
        p.stepPx = 1 << i;
        p.weights = settings.filterWeights == FilterWeights::Plane ? ATROUS_WEIGHTS_PLANE : ATROUS_WEIGHTS_DEPTH;
        p.depthTolerance = settings.filterDepth;
        p.inverseNormalTolerance = 1.0f / settings.filterNormal;
        p.inverseStep = 1.0f / float(p.stepPx);
        // Each iteration leaves less noise: a fourth of the variance, or so.
        p.luminanceTolerance = keepsMoment(settings) ? std::ldexp(settings.filterLuminance, -i) : 0.0f;
        p.fadeFrames = fadeFrames(settings, i);
        // What it takes, history gives back as it grows: so only with one, and not in what that remembers.
        p.limitsLone = settings.accumulates && settings.feedback == 0 && i == 0 && p.weights == ATROUS_WEIGHTS_PLANE;
        p.footprintM = lengthOf(frame.cameraRays.originDx);
        p.footprintPerM = lengthOf(frame.cameraRays.rayDx);
        const bool isSmall = settings.filterKernel == FilterKernel::Square3x3;
        p.share0 = isSmall ? 1.0f / 2.0f : 3.0f / 8.0f;
        p.share1 = 1.0f / 4.0f;
        p.share2 = isSmall ? 0.0f : 1.0f / 16.0f;
        p.radiusX = p.radiusY = isSmall ? 1 : 2;
        if (settings.filterKernel == FilterKernel::Separable) {
            p.radiusY = 0;
            passes.push_back(p);
            std::swap(p.radiusX, p.radiusY);
        }
        passes.push_back(p);
    }
    return passes;
}

}  // namespace

bool keepsMoment(const Settings& settings) {
    return settings.filterLuminance > 0.0f && settings.filterIterations > 0 &&
           settings.filterWeights == FilterWeights::Plane;
}

FrameParams makeParams(const Settings& settings, const FrameGeometry& full) {
    constexpr float kMiddleGrey = 0.18f;  // what photographers and displays take for the middle
    FrameParams p;
    // Indirect light sees the picked pixels; direct light sees all.
    const PickGrid grid = makePickGrid(full.extent, settings.divisor);
    FrameGeometry frame = full;
    frame.cameraRays = pickedRays(full.cameraRays, grid);
    frame.previousRays = pickedRays(full.previousRays, grid);
    p.divisor = settings.divisor;
    p.upsampling = settings.upsampling;
    p.fullRays = full.cameraRays;
    p.estimator = settings.estimator;
    p.pattern = settings.pattern;
    const int frameIndex = settings.animatesNoise ? frame.frameIndex : 0;
    const int mapSizePx = minifiedSizePx(frame.rsmSizePx, settings.rsmMinify);
    // A full sum is the same in every frame, of a minified map too.
    const u32 pickSeed = settings.estimator == Estimator::Sum ? 0u : u32(frameIndex);
    p.pack = {frame.rsmSizePx, frame.lightCount, settings.rsmMinify, pickSeed};
    p.gather.cameraRays = frame.cameraRays;
    p.gather.rsmSizePx = mapSizePx;
    p.gather.mapScale = float(frame.rsmSizePx) / float(std::max(mapSizePx * settings.rsmMinify, 1));
    p.gather.lightCount = frame.lightCount;
    p.gather.sampleCount = settings.sampleCount;
    p.gather.radiusUv = settings.radiusUv;
    p.gather.rotation = settings.rotation == Rotation::Off    ? ROTATION_OFF
                        : settings.rotation == Rotation::Tile ? ROTATION_TILE
                                                              : ROTATION_NOISE;
    p.gather.mapping = settings.mapping == RadiusMapping::Area    ? MAPPING_AREA
                       : settings.mapping == RadiusMapping::Polar ? MAPPING_POLAR
                                                                  : MAPPING_SQUARED;
    const FrameMove move = makeFrameMove(frameIndex, settings.sampleCount);
    p.gather.frameShift = float(move.shift);
    p.gather.frameTurnCos = float(std::cos(2.0 * std::numbers::pi * move.turn));
    p.gather.frameTurnSin = float(std::sin(2.0 * std::numbers::pi * move.turn));
    p.sharesTexels = settings.estimator == Estimator::Disk && settings.rotation == Rotation::Coherent;
    p.choose.gather = p.gather;
    p.choose.frameCentre = float(move.centre);
    p.sum.cameraRays = frame.cameraRays;
    p.sum.rsmSizePx = mapSizePx;
    p.sum.lightCount = frame.lightCount;
    p.averagesTile = settings.estimator == Estimator::Disk && settings.rotation == Rotation::Tile;
    p.tileAverage = tileAverageParams(frame);
    p.accumulates = settings.accumulates;
    p.denoises = settings.accumulates || settings.filterIterations > 0;
    p.temporal = temporalParams(settings, frame);
    p.checksHistory = settings.accumulates && settings.antiLag > 0.0f;
    // The check takes pixels for independent. A tile's mean is one for all of its 16 pixels; of a set, whose noise is
    // alike, the three tiles beside one another that it looks at hold 12.
    const float alikePixels = p.averagesTile ? 16.0f : p.sharesTexels ? 12.0f : 1.0f;
    p.historyCheck.droppedAbove = settings.antiLag * alikePixels;
    p.historyCheck.keptBelow = 0.5f * p.historyCheck.droppedAbove;
    p.keepsMoment = keepsMoment(settings);
    p.filterPasses = filterPasses(settings, frame);
    p.feedbackPasses = settings.feedback * (settings.filterKernel == FilterKernel::Separable ? 2 : 1);
    p.directLight.cameraRays = full.cameraRays;
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
