// temporal: what this frame's samples say, averaged with what is remembered of the same surface point.
//   out = mix(history(x'), in, 1 / n),   n = min(c n_history(x') + 1, maxFrames)
//   x' is where the point was in the previous frame (motion vectors); history there is a bilinear mean over those of the
//   2 x 2 pixels around x' that saw the same surface: near the plane through the point as it was then, with a like normal.
//   Where none did, a 3 x 3 search with looser bounds rescues what it can; where that finds nothing, n starts at 1.
//   Nehab et al. 2007; Schied et al. 2017, who compare depths: a plane's distance is as strict on slopes as it is ahead.
//   c is history_confidence's. A sample brighter than fireflyFactor times everything near it and than its history
//   is cut to that, also when it has no history.
//   in   inIrradiance     lx: this frame's estimate
//   in   inNormalWs, inDepth   unit; m, 0 on sky
//   in   inMotion         xy: px to the same point in the previous frame, z: m, previous depth minus this; if hasMotion
//   in   prevNormalWs, prevDepth   of the previous frame
//   in   historyIrradiance  lx
//   in   historyLength    frames, >= 1; 0 on sky
//   in   historyMoment    lx^2: mean squared luminance of the samples
//   in   confidence       one float a tile of CONFIDENCE_TILE_PX, rows of tiles; if usesConfidence
//   out  outIrradiance, outLength, outMoment   finite; 0 on sky
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "geometry.clh"
#include "history_check_params.h"
#include "surface.clh"
#include "temporal_params.h"

// Sums over the taps of history that saw the same surface.
typedef struct History {
    vfloat weight;
    vfloat3 irradiance;
    vfloat length, moment;
} History;

static void addTap(History* h, vfloat weight, vfloat3 irradiance, vfloat length, vfloat moment) {
    h->weight += weight;
    h->irradiance = mad3(weight, irradiance, h->irradiance);
    h->length = vmad(weight, length, h->length);
    h->moment = vmad(weight, moment, h->moment);
}

// Did pixel (x, y) of the previous frame see the plane through `point`?
static vmask isSameSurface(const TemporalParams* params, float looseness, vint x, vint y, vfloat depth, vfloat3 normal,
                           vfloat3 point, vfloat pointDepth, vfloat3 pointNormal) {
    vfloat3 d = sub3(positionFromDepth(&params->previousRays, x, y, depth), point);
    vfloat tolerance = looseness * params->planeTolerance * pointDepth;
    vmask isThere = depth > 0.0f, isOnPlane = fabs(dot3(pointNormal, d)) <= tolerance;
    vmask isTurned = dot3(pointNormal, normal) < params->minNormalCosine;
    return vselectInt(isTurned, 0, isThere & isOnPlane);
}

// Linear between the centres of tiles. A work-item's lanes lie in one column of tiles.
static vfloat confidenceAt(__global const float* confidence, Pixel px, SurfaceLayout layout) {
    int columns = (layout.widthPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX;
    int rows = (layout.heightPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX;
    int i = px.x / CONFIDENCE_TILE_PX, j = px.y / CONFIDENCE_TILE_PX;
    float v = ((float)(px.y % CONFIDENCE_TILE_PX) + 0.5f) / CONFIDENCE_TILE_PX - 0.5f;
    int otherRow = clamp(v < 0.0f ? j - 1 : j + 1, 0, rows - 1);
    float c[3];
    for (int k = 0; k < 3; ++k) {
        int column = clamp(i + k - 1, 0, columns - 1);
        float here = confidence[j * columns + column];
        c[k] = here + fabs(v) * (confidence[otherRow * columns + column] - here);
    }
    vfloat u = (toVfloat(px.x % CONFIDENCE_TILE_PX + laneIndex()) + 0.5f) / CONFIDENCE_TILE_PX - 0.5f;
    return c[1] + max(u, 0.0f) * (c[2] - c[1]) + max(-u, 0.0f) * (c[0] - c[1]);
}

// The brightest of the eight pixels around.
#define NEIGHBOUR_LUMINANCE(NAME, PX) neighbourLuminance(NAME, NAME##Layout, PX)
static vfloat neighbourLuminance(SURFACE_IN(inIrradiance), Pixel px) {
    vfloat brightest = 0.0f;
    for (int j = -1; j <= 1; ++j) {
        int y = px.y + j;
        if (y < 0 || y >= inIrradianceLayout.heightPx) continue;
        for (int i = -1; i <= 1; ++i) {
            if (i == 0 && j == 0) continue;
            vint x = px.x + i + laneIndex();
            vfloat l = luminance(loadFrom3(inIrradiance, px.x + i, y));
            brightest = vselect((x >= 0) & (x < inIrradianceLayout.widthPx), max(brightest, l), brightest);
        }
    }
    return brightest;
}

__kernel void temporal(SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(inMotion),
                       SURFACE_IN(prevNormalWs), SURFACE_IN(prevDepth), SURFACE_IN(historyIrradiance),
                       SURFACE_IN(historyLength), SURFACE_IN(historyMoment), __global const float* restrict confidence,
                       SURFACE_OUT(outIrradiance), SURFACE_OUT(outLength), SURFACE_OUT(outMoment),
                       const TemporalParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outIrradianceLayout)) return;
    const vfloat3 zero3 = make3(0.0f, 0.0f, 0.0f);
    vfloat depth = load1(inDepth, px);
    vmask isSurface = depth > 0.0f;
    if (!anyLane(isSurface)) {
        store3(outIrradiance, px, zero3);
        store1(outLength, px, 0.0f);
        store1(outMoment, px, 0.0f);
        return;
    }
    vfloat3 normalWs = load3(inNormalWs, px);
    vfloat3 irradiance = load3(inIrradiance, px);
    // What is brighter than any light counts as this much: squares, here and in what follows, stay finite.
    irradiance = make3(min(irradiance.x, 1e15f), min(irradiance.y, 1e15f), min(irradiance.z, 1e15f));
    int width = outIrradianceLayout.widthPx, height = outIrradianceLayout.heightPx;

    History h = {0.0f, zero3, 0.0f, 0.0f};
    if (params.hasHistory) {
        vfloat3 motion = zero3;
        if (params.hasMotion) motion = load3(inMotion, px);
        // What moves by less than this stays: a picture at rest is not resampled for rounding's sake.
        vmask moves = isSurface & (max(fabs(motion.x), fabs(motion.y)) > 1.0f / 256.0f);
        vint x = px.x + laneIndex(), y = (vint)(px.y);
        if (!anyLane(moves)) {
            vfloat depthThen = depth + motion.z;
            vfloat3 point = positionFromDepth(&params.previousRays, x, y, depthThen);
            vfloat tapDepth = load1(prevDepth, px);
            vmask isSame = isSameSurface(&params, 1.0f, x, y, tapDepth, load3(prevNormalWs, px), point, depthThen, normalWs);
            addTap(&h, vselect(isSame, 1.0f, 0.0f), load3(historyIrradiance, px), load1(historyLength, px),
                   load1(historyMoment, px));
        } else {
            vfloat fx = toVfloat(x) + motion.x, fy = toVfloat(y) + motion.y;
            // Beyond this the taps are outside anyway; 32-bit integers must hold them.
            fx = min(max(fx, -8.0f), (float)width + 8.0f);
            fy = min(max(fy, -8.0f), (float)height + 8.0f);
            vfloat depthThen = max(depth + motion.z, 0.0f);
            vfloat3 point = positionFromDepthAt(&params.previousRays, fx, fy, depthThen);
            vfloat x0 = floor(fx), y0 = floor(fy);
            vfloat u = fx - x0, v = fy - y0;
            for (int tap = 0; tap < 4; ++tap) {
                int i = tap & 1, j = tap >> 1;
                vint tx = toVint(x0) + i, ty = toVint(y0) + j;
                vmask isInside = (tx >= 0) & (tx < width) & (ty >= 0) & (ty < height);
                tx = min(max(tx, 0), width - 1);
                ty = min(max(ty, 0), height - 1);
                vmask isSame = isInside & isSameSurface(&params, 1.0f, tx, ty, gather1(prevDepth, tx, ty),
                                                        gather3(prevNormalWs, tx, ty), point, depthThen, normalWs);
                vfloat weight = (i ? u : 1.0f - u) * (j ? v : 1.0f - v);
                addTap(&h, vselect(isSame, weight, 0.0f), gather3(historyIrradiance, tx, ty),
                       gather1(historyLength, tx, ty), gather1(historyMoment, tx, ty));
            }
            vmask isLost = isSurface & (h.weight < 0.01f);
            if (anyLane(isLost)) {
                History r = {0.0f, zero3, 0.0f, 0.0f};
                vint nearestX = toVint(floor(fx + 0.5f)), nearestY = toVint(floor(fy + 0.5f));
                for (int tap = 0; tap < 9; ++tap) {
                    vint tx = nearestX + (tap % 3 - 1), ty = nearestY + (tap / 3 - 1);
                    vmask isInside = (tx >= 0) & (tx < width) & (ty >= 0) & (ty < height);
                    tx = min(max(tx, 0), width - 1);
                    ty = min(max(ty, 0), height - 1);
                    vmask isSame = isInside & isSameSurface(&params, 2.0f, tx, ty, gather1(prevDepth, tx, ty),
                                                            gather3(prevNormalWs, tx, ty), point, depthThen, normalWs);
                    vfloat dx = toVfloat(tx) - fx, dy = toVfloat(ty) - fy;
                    vfloat weight = 1.0f / (1.0f + dx * dx + dy * dy);
                    addTap(&r, vselect(isSame, weight, 0.0f), gather3(historyIrradiance, tx, ty),
                           gather1(historyLength, tx, ty), gather1(historyMoment, tx, ty));
                }
                h.weight = vselect(isLost, r.weight, h.weight);
                h.irradiance = select3(isLost, r.irradiance, h.irradiance);
                h.length = vselect(isLost, r.length, h.length);
                h.moment = vselect(isLost, r.moment, h.moment);
            }
        }
    }
    vmask isRemembered = h.weight >= 0.01f;
    vfloat inverseWeight = vselect(isRemembered, 1.0f / max(h.weight, 0.01f), 0.0f);
    vfloat3 remembered = scale3(inverseWeight, h.irradiance);
    vfloat length = inverseWeight * h.length;
    if (params.usesConfidence) length *= confidenceAt(confidence, px, outIrradianceLayout);

    if (params.fireflyFactor > 0.0f) {
        vfloat brightest = max(NEIGHBOUR_LUMINANCE(inIrradiance, px), luminance(remembered));
        vfloat l = luminance(irradiance);
        irradiance = scale3(min(params.fireflyFactor * brightest / max(l, 1e-30f), 1.0f), irradiance);
    }
    length = min(length + 1.0f, params.maxFrames);
    vfloat share = vselect(isRemembered, 1.0f / length, 1.0f);
    vfloat l = luminance(irradiance);
    vfloat moment = vmad(share, l * l - inverseWeight * h.moment, inverseWeight * h.moment);
    vfloat3 accumulated = mad3(share, sub3(irradiance, remembered), remembered);
    store3(outIrradiance, px, select3(isSurface, accumulated, zero3));
    store1(outLength, px, vselect(isSurface, length, 0.0f));
    store1(outMoment, px, vselect(isSurface, max(moment, 0.0f), 0.0f));
}
