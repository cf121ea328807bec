// temporal: what this frame's samples say, averaged with what is remembered of the same surface point.
//   out = mix(history(x'), in, 1 / n),   n = min(c n_history(x') + 1, maxFrames)
//   x' is where the point was in the previous frame (motion vectors); history there is a bilinear mean over those of the
//   2 x 2 pixels around x' that saw the same surface: near the plane through the point as it was then, with a like normal.
//   A tap turned by some counts for less, s = 1 - |n - n'|^2 / normalTolerance, and its frames for s^2 of theirs: where
//   geometry is as fine as pixels, history of what only nearly fits is worth few frames, not all (weighsTurn; else 1).
//   Where none did, a 3 x 3 search with looser bounds rescues what it can; where that finds nothing, n starts at 1.
//   Nehab et al. 2007; Schied et al. 2017, who compare depths: a plane's distance is as strict on slopes as it is ahead.
//   c is history_confidence's. A sample brighter than fireflyFactor times everything near it and than its history
//   is cut to that, also when it has no history; unless all else is dark.
//   in   inIrradiance     lx: this frame's estimate
//   in   inNormalWs, inDepth   unit; m, 0 on sky
//   in   inMotion         xy: px to the same point in the previous frame, z: m, previous depth minus this; if hasMotion
//   in   prevNormalWs, prevDepth   of the previous frame
//   in   historyIrradiance  lx
//   in   historyLength    frames, >= 1; 0 on sky
//   in   historyMoment    lx^2: mean squared luminance of the samples; if keepsMoment
//   in   confidence       one float a tile of CONFIDENCE_TILE_PX, rows of tiles; if usesConfidence
//   out  outIrradiance, outLength, outMoment   finite; 0 on sky; the moment if keepsMoment
//   out  outChange        lx: luminance of the sample, so limited, less that of outIrradiance; finite, 0 on sky
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

// The plane through a point as it was in the previous frame, as that frame's pixels see it. With x = origin + depth ray,
// linear in the pixel, a point that pixel (x, y) saw lies slope depth + offset off it, linear in the pixel too.
typedef struct SeenPlane {
    vfloat x, y, depth;  // px, px, m: where the plane's point was
    vfloat3 normal;
    vfloat slope, slopeX, slopeY, offsetX, offsetY;
} SeenPlane;

static SeenPlane seenPlane(const ViewRays* rays, vfloat x, vfloat y, vfloat depth, vfloat3 normal) {
    SeenPlane p = {x, y, depth, normal, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    p.slopeX = dot3(normal, splat3(rays->rayDx));
    p.slopeY = dot3(normal, splat3(rays->rayDy));
    p.slope = vmad(x, p.slopeX, vmad(y, p.slopeY, dot3(normal, splat3(rays->ray))));
    p.offsetX = dot3(normal, splat3(rays->originDx));
    p.offsetY = dot3(normal, splat3(rays->originDy));
    return p;
}

// How far the pixel that is (dx, dy) away from the point saw the same: 0 = another surface, 1 = as it is.
static vfloat likeness(const SeenPlane* p, const TemporalParams* params, float looseness, vfloat dx, vfloat dy,
                       vfloat depth, vfloat3 normal) {
    vfloat distance = (depth - p->depth) * p->slope;
    distance = vmad(dx, vmad(depth, p->slopeX, p->offsetX), distance);
    distance = vmad(dy, vmad(depth, p->slopeY, p->offsetY), distance);
    vfloat tolerance = looseness * params->planeTolerance * p->depth;
    vfloat3 turn = sub3(normal, p->normal);
    vfloat like = max(1.0f - dot3(turn, turn) * params->inverseNormalTolerance, 0.0f);
    if (!params->weighsTurn) like = vselect(like > 0.0f, 1.0f, 0.0f);
    return vselect((depth > 0.0f) & (fabs(distance) <= tolerance), like, 0.0f);
}

// Adds the side x side pixels from (left, top) on that saw the same surface: bilinear weights for 2, for 3 what is
// nearer more. Where a work-item's pixels move alike, as nearly all do, they are rows, not to be gathered one by one.
static void addTaps(History* h, SURFACE_IN(prevNormalWs), SURFACE_IN(prevDepth), SURFACE_IN(historyIrradiance),
                    SURFACE_IN(historyLength), SURFACE_IN(historyMoment), const TemporalParams* params,
                    const SeenPlane* plane, vmask isWanted, vint left, vint top, int side, float looseness) {
    int width = prevDepthLayout.widthPx, height = prevDepthLayout.heightPx;
    int rowX = firstLane(left), rowY = firstLane(top);
    bool isRow = !anyLane(isWanted & ((left - laneIndex() != rowX) | (top != rowY)));
    for (int tap = 0; tap < side * side; ++tap) {
        int i = tap % side, j = tap / side;
        vint x = left + i, y = top + j;
        vmask isInside = isWanted & (x >= 0) & (x < width) & (y >= 0) & (y < height);
        if (!anyLane(isInside)) continue;
        vfloat depth, length, moment = 0.0f;
        vfloat3 normal, irradiance;
        if (isRow) {
            depth = loadFrom1(prevDepth, rowX + i, rowY + j);
            normal = loadFrom3(prevNormalWs, rowX + i, rowY + j);
            irradiance = loadFrom3(historyIrradiance, rowX + i, rowY + j);
            length = loadFrom1(historyLength, rowX + i, rowY + j);
            if (params->keepsMoment) moment = loadFrom1(historyMoment, rowX + i, rowY + j);
        } else {
            vint inX = clampInt(x, 0, width - 1), inY = clampInt(y, 0, height - 1);
            depth = gather1(prevDepth, inX, inY);
            normal = gather3(prevNormalWs, inX, inY);
            irradiance = gather3(historyIrradiance, inX, inY);
            length = gather1(historyLength, inX, inY);
            if (params->keepsMoment) moment = gather1(historyMoment, inX, inY);
        }
        vfloat dx = toVfloat(x) - plane->x, dy = toVfloat(y) - plane->y;
        vfloat weight = side == 2 ? (1.0f - fabs(dx)) * (1.0f - fabs(dy)) : 1.0f / (1.0f + dx * dx + dy * dy);
        vfloat like = likeness(plane, params, looseness, dx, dy, depth, normal);
        weight = vselect(isInside, weight * like, 0.0f);
        h->weight += weight;
        h->irradiance = mad3(weight, irradiance, h->irradiance);
        h->length = vmad(weight * like * like, length, h->length);
        h->moment = vmad(weight, moment, h->moment);
    }
}

// What history_confidence.cl made of the previous frame at that frame's pixel (x, y), linear between the centres of tiles.
static vfloat confidenceAt(__global const float* confidence, SurfaceLayout layout, vint x, vint y) {
    int columns = (layout.widthPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX;
    int rows = (layout.heightPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX;
    vfloat u = (toVfloat(x) + 0.5f) / CONFIDENCE_TILE_PX - 0.5f, v = (toVfloat(y) + 0.5f) / CONFIDENCE_TILE_PX - 0.5f;
    vint left = toVint(floor(u)), top = toVint(floor(v));
    u -= floor(u);
    v -= floor(v);
#if LANES > 1
    // A row of pixels lies between the centres of three tiles: six numbers for all lanes.
    int firstLeft = firstLane(left), firstTop = firstLane(top);
    if (!anyLane((x - laneIndex() != firstLane(x)) | (y != firstLane(y)))) {
        int upperRow = clamp(firstTop, 0, rows - 1) * columns, lowerRow = clamp(firstTop + 1, 0, rows - 1) * columns;
        float at[3], down = firstLane(v);
        for (int k = 0; k < 3; ++k) {
            int column = clamp(firstLeft + k, 0, columns - 1);
            at[k] = confidence[upperRow + column];
            at[k] += down * (confidence[lowerRow + column] - at[k]);
        }
        vmask isNext = left > firstLeft;
        vfloat from = vselect(isNext, at[1], at[0]);
        return from + u * (vselect(isNext, at[2], at[1]) - from);
    }
#endif
    vint column0 = clampInt(left, 0, columns - 1), column1 = clampInt(left + 1, 0, columns - 1);
    vint row0 = clampInt(top, 0, rows - 1) * columns, row1 = clampInt(top + 1, 0, rows - 1) * columns;
    vfloat upper = gatherFloats(confidence, row0 + column0), lower = gatherFloats(confidence, row1 + column0);
    upper += u * (gatherFloats(confidence, row0 + column1) - upper);
    lower += u * (gatherFloats(confidence, row1 + column1) - lower);
    return upper + v * (lower - upper);
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

#define HISTORY_ARGS                                                                                              \
    SURFACE_ARG(prevNormalWs), SURFACE_ARG(prevDepth), SURFACE_ARG(historyIrradiance), SURFACE_ARG(historyLength), \
        SURFACE_ARG(historyMoment)

__kernel void temporal(SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(inMotion),
                       SURFACE_IN(prevNormalWs), SURFACE_IN(prevDepth), SURFACE_IN(historyIrradiance),
                       SURFACE_IN(historyLength), SURFACE_IN(historyMoment), __global const float* restrict confidence,
                       SURFACE_OUT(outIrradiance), SURFACE_OUT(outLength), SURFACE_OUT(outMoment), SURFACE_OUT(outChange),
                       const TemporalParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outIrradianceLayout)) return;
    const vfloat3 zero3 = make3(0.0f, 0.0f, 0.0f);
    vfloat depth = load1(inDepth, px);
    vmask isSurface = depth > 0.0f;
    vfloat3 normalWs = zero3, irradiance = zero3, motion = zero3;
    if (LANES == 1 || anyLane(isSurface)) {  // on a GPU before the first branch, so that all are under way together
        normalWs = load3(inNormalWs, px);
        irradiance = load3(inIrradiance, px);
        if (params.hasMotion) motion = load3(inMotion, px);
    }
    if (!anyLane(isSurface)) {
        store3(outIrradiance, px, zero3);
        store1(outLength, px, 0.0f);
        store1(outChange, px, 0.0f);
        if (params.keepsMoment) store1(outMoment, px, 0.0f);
        return;
    }
    // What is brighter than any light counts as this much: squares, here and in what follows, stay finite.
    irradiance = make3(min(irradiance.x, 1e15f), min(irradiance.y, 1e15f), min(irradiance.z, 1e15f));
    int width = outIrradianceLayout.widthPx, height = outIrradianceLayout.heightPx;

    History h = {0.0f, zero3, 0.0f, 0.0f};
    if (params.hasHistory) {
        // What moves by less than this stays: a picture at rest is not resampled for rounding's sake.
        vmask moves = isSurface & (max(fabs(motion.x), fabs(motion.y)) > 1.0f / 256.0f);
        vfloat fx = toVfloat(px.x + laneIndex()) + vselect(moves, motion.x, 0.0f);
        vfloat fy = (float)px.y + vselect(moves, motion.y, 0.0f);
        // Beyond this the taps are outside anyway; 32-bit integers must hold them.
        fx = min(max(fx, -8.0f), (float)width + 8.0f);
        fy = min(max(fy, -8.0f), (float)height + 8.0f);
        vint left = toVint(floor(fx)), top = toVint(floor(fy));
        SeenPlane plane = seenPlane(&params.previousRays, fx, fy, max(depth + motion.z, 0.0f), normalWs);
        if (!anyLane(moves)) {
            vfloat like =
                likeness(&plane, &params, 1.0f, 0.0f, 0.0f, load1(prevDepth, px), load3(prevNormalWs, px));
            h.weight = vselect(isSurface, like, 0.0f);
            h.irradiance = scale3(h.weight, load3(historyIrradiance, px));
            h.length = h.weight * like * like * load1(historyLength, px);
            if (params.keepsMoment) h.moment = h.weight * load1(historyMoment, px);
        }
        // First the four around; then, for what they know nothing of, the nine.
        for (int side = anyLane(moves) ? 2 : 3; side <= 3; ++side) {
            vmask isLost = isSurface & (h.weight < 0.01f);
            if (!anyLane(isLost)) break;
            History found = {0.0f, zero3, 0.0f, 0.0f};
            float rounding = side == 2 ? 0.0f : 0.5f;
            int back = side - 2;
            addTaps(&found, HISTORY_ARGS, &params, &plane, isLost, toVint(floor(fx + rounding)) - back,
                    toVint(floor(fy + rounding)) - back, side, (float)(side - 1));
            h.weight = vselect(isLost, found.weight, h.weight);
            h.irradiance = select3(isLost, found.irradiance, h.irradiance);
            h.length = vselect(isLost, found.length, h.length);
            h.moment = vselect(isLost, found.moment, h.moment);
        }
        if (params.usesConfidence) h.length *= confidenceAt(confidence, outIrradianceLayout, left, top);
    }
    vmask isRemembered = h.weight >= 0.01f;
    vfloat inverseWeight = vselect(isRemembered, 1.0f / max(h.weight, 0.01f), 0.0f);
    vfloat3 remembered = scale3(inverseWeight, h.irradiance);
    vfloat length = inverseWeight * h.length;

    if (params.fireflyFactor > 0.0f) {
        vfloat brightest = max(NEIGHBOUR_LUMINANCE(inIrradiance, px), luminance(remembered));
        vfloat l = luminance(irradiance);
        vfloat limit = vselect(brightest > 0.0f, params.fireflyFactor * brightest, l);  // where all else is dark, none
        irradiance = scale3(min(limit / max(l, 1e-30f), 1.0f), irradiance);
    }
    length = min(length + 1.0f, params.maxFrames);
    vfloat share = vselect(isRemembered, 1.0f / length, 1.0f);
    vfloat3 accumulated = mad3(share, sub3(irradiance, remembered), remembered);
    vfloat l = luminance(irradiance);
    store3(outIrradiance, px, select3(isSurface, accumulated, zero3));
    store1(outLength, px, vselect(isSurface, length, 0.0f));
    store1(outChange, px, vselect(isSurface, l - luminance(accumulated), 0.0f));
    if (params.keepsMoment) {
        vfloat then = inverseWeight * h.moment;
        store1(outMoment, px, vselect(isSurface, max(vmad(share, l * l - then, then), 0.0f), 0.0f));
    }
}
