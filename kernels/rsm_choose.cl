// rsm_choose: the texels that a set of pixels gathers from, all of the set the same (rsm_gather_coherent.cl).
//   W(p) for each chosen texel p, so that sum_p W(p) Phi_p G(p, x) has the mean of the full sum at each pixel x
//   A set is every fourth pixel of 64 of a row: neighbours belong to other sets, so that a filter's first taps hold
//   many, and yet a set is lit alike. Interleaved sampling: Keller & Heidrich 2001.
//   Texels lie in disks as rsm_gather.cl's, around the projections of the set's pixels in turn. Their density is the
//   mean of all these disks' (the balance heuristic of Veach & Guibas 1995), so that what is near one of the pixels is
//   never improbable. Without bias wherever the disks are, as each covers the map, or as much of it as its radius says.
//   in   inDepth     m; 0 on sky
//   in   lights, pattern, noise   as rsm_gather.cl
//   out  outChoices  RsmChoice, sampleCount a set; weight 0 beyond the map, and where all of a set is sky. Ordered by
//                    light, row, set
//   Work 2D, one item per LANES sets of a row, any local size; items past the end return.

#include "mixed.clh"
#include "rsm_choose_params.h"
#include "rsm_gather.clh"
#include "surface.clh"

#define SET_PX (COHERENT_SPAN_PX / COHERENT_STRIDE_PX)

typedef struct SetPoints {
    vfloat3 positionWs[SET_PX];
    vmask isSurface;  // any of them
} SetPoints;

// The pixels of the set; in place of sky or of what lies outside, the one before that does
// not, or at the start the one after.
static SetPoints pointsOf(SURFACE_IN(inDepth), const ViewRays* rays, vint firstX, int y) {
    SetPoints points;
    vint x[SET_PX];
    vfloat depth[SET_PX];
    for (int i = 0; i < SET_PX; ++i) {
        x[i] = firstX + i * COHERENT_STRIDE_PX;
        vmask isInside = x[i] < inDepthLayout.widthPx;
        x[i] = vselectInt(isInside, x[i], 0);
        depth[i] = vselect(isInside, gather1(inDepth, x[i], (vint)(y)), 0.0f);
        if (i == 0) continue;
        x[i] = vselectInt(depth[i] > 0.0f, x[i], x[i - 1]);
        depth[i] = vselect(depth[i] > 0.0f, depth[i], depth[i - 1]);
    }
    points.isSurface = depth[SET_PX - 1] > 0.0f;
    for (int i = SET_PX - 1; i >= 0; --i) {
        if (i < SET_PX - 1) {
            x[i] = vselectInt(depth[i] > 0.0f, x[i], x[i + 1]);
            depth[i] = vselect(depth[i] > 0.0f, depth[i], depth[i + 1]);
        }
        points.positionWs[i] = positionFromDepth(rays, x[i], (vint)(y), depth[i]);
    }
    return points;
}

// x^(-3/4) for x in [1e-12; 1e12], relative error below 6e-5: a line through the logarithm, which the bits of a float
// nearly are, and two steps of Newton's method towards x^3 = y^-4. With two roots and a division instead, all of the
// kernel took 1.35 times as long on a CPU.
static vfloat inverseThreeQuarters(vfloat x) {
    vfloat y = asVfloat(0x6f14c000 - (asVint(x) >> 2) * 3);
    vfloat cube = x * x * x;
    for (int i = 0; i < 2; ++i) {
        vfloat square = y * y;
        y *= vmad(-0.25f * cube, square * square, 1.25f);
    }
    return y;
}

// How densely a disk's points lie at a distance from its centre, times a factor that all distances share.
static vfloat diskDensity(float radius, vfloat r2) {
    vfloat density = 1.0f;
    r2 = max(r2, 1e-12f);  // finite at the centre
    if (MAPPING == MAPPING_POLAR) density = rsqrt(r2);
    if (MAPPING == MAPPING_SQUARED) density = inverseThreeQuarters(r2);
    return vselect(r2 < radius * radius, density, 0.0f);
}
// One over that factor: the integral over the disk.
static float diskIntegral(float radius) {
    if (MAPPING == MAPPING_AREA) return ES_PI * radius * radius;
    return MAPPING == MAPPING_POLAR ? 2.0f * ES_PI * radius : 4.0f * ES_PI * sqrt(radius);
}

__kernel void rsm_choose(SURFACE_IN(inDepth), __global const LightParams* restrict lights,
                         __global const float4* restrict pattern, __global const float* restrict noise,
                         __global RsmChoice* restrict outChoices, const RsmChooseParams params) {
    int setsInRow = (inDepthLayout.widthPx + COHERENT_SPAN_PX - 1) / COHERENT_SPAN_PX * COHERENT_STRIDE_PX;
    int firstSet = (int)get_global_id(0) * LANES, row = (int)get_global_id(1);
    if (firstSet >= setsInRow || row >= params.rowCount) return;
    int y = params.firstRowPx + row;
    vint set = firstSet + laneIndex();
    vint firstX = set / COHERENT_STRIDE_PX * COHERENT_SPAN_PX + set % COHERENT_STRIDE_PX;
    SetPoints points = pointsOf(SURFACE_ARG(inDepth), &params.gather.cameraRays, firstX, y);

    const int noiseSize = ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX;
    vint at = y % ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX + set % ROTATION_NOISE_SIZE_PX;
    PatternMove move = patternMove(&params.gather, gatherFloats(noise, at), gatherFloats(noise + noiseSize, at),
                                   gatherFloats(noise + 2 * noiseSize, at));
    // Which centre takes which sample: the golden ratio's sequence, from anywhere, else for each row and frame.
    float start = firstLane(fractionOf(mixed((vuint)(y)))) + params.frameCentre;

    int size = params.gather.rsmSizePx, sampleCount = params.gather.sampleCount;
    for (int l = 0; l < params.gather.lightCount; ++l) {
        const LightParams light = lights[l];
        vfloat cx[SET_PX], cy[SET_PX];
        for (int i = 0; i < SET_PX; ++i) diskCentre(&params.gather, &light, points.positionWs[i], &cx[i], &cy[i]);
        float radius = (light.gatherRadiusUv > 0.0f ? light.gatherRadiusUv : params.gather.radiusUv) * (float)size;
        float scale = light.indirectScale * ES_INV_PI * (float)SET_PX * diskIntegral(radius) / (float)sampleCount;
        __global RsmChoice* out = outChoices + ((l * params.rowCount + row) * setsInRow + firstSet) * sampleCount;
        for (int s = 0; s < sampleCount; ++s) {
            vfloat fx, fy;
            diskPoint(&params.gather, pattern[s], move, radius, &fx, &fy);
            float turn = (float)s * 0.618034f + start;
            int centre = min((int)((turn - floor(turn)) * (float)SET_PX), SET_PX - 1);
            fx += cx[centre];
            fy += cy[centre];
            vmask isInside = (fx >= 0.0f) & (fx < (float)size) & (fy >= 0.0f) & (fy < (float)size) & points.isSurface;
            vfloat density = 0.0f;
            for (int i = 0; i < SET_PX; ++i) {
                vfloat dx = fx - cx[i], dy = fy - cy[i];
                density += diskDensity(radius, vmad(dx, dx, dy * dy));
            }
            VintLanes texel;
            VfloatLanes weight;
            texel.v = vselectInt(isInside, (toVint(fy) + l * size) * size + toVint(fx), l * size * size);
            // A point at its own disk's rim may round to beyond it.
            weight.v = vselect(isInside & (density > 0.0f), scale / density, 0.0f);
            for (int i = 0; i < min(LANES, setsInRow - firstSet); ++i) {
                RsmChoice choice = {texel.lane[i], weight.lane[i]};
                out[i * sampleCount + s] = choice;
            }
        }
    }
}
