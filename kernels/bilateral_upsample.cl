// bilateral_upsample: irradiance of a lower resolution brought to every pixel, along surfaces and not across their
//   edges. (Not "upsample": that is a function of OpenCL C.)
//   E(x) = sum_t b_t p_t c_t E_t / sum_t b_t p_t c_t   over the 2 x 2 texels t around pixel x
//   b: bilinear weights; p = max(0, 1 - d^2), d the texel's distance from x's plane in widths of a texel there;
//   c = max(0, n.n_t)^8
//   Kopf et al. 2007, Joint Bilateral Upsampling, whose range weight compares colours. Ours compares planes, since a
//   floor that runs away from the camera has depths of every kind and is one surface. p ends at a distance, so that
//   nothing bleeds over an edge; c does not need to: light changes with the normal itself, by the cosine.
//   Where none of the four fits, the best single one of the 3 x 3 around the nearest: by d / (1 + d) + 1 - n.n_t, and
//   among equals the nearer.
//   in   inNormalWs, inDepth     the full picture: unit; m, 0 on sky
//   in   lowNormalWs, lowDepth   the picked one, by downsample
//   in   lowIrradiance           lx
//   out  outIrradiance  lx, finite, between the least and the largest of the texels that it comes from; 0 on sky, and
//                       where all of the 3 x 3 are sky: there is nothing to take
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "pick_grid.clh"
#include "bilateral_upsample_params.h"

// Less than this in sum, and the four do not fit: a hundredth of what the farthest of four gets by its place alone.
#define MIN_WEIGHT 6e-4f

// The 3 x 3, row by row from 0, the nearer first: the middle, and then these, a nibble each from the lowest. Each costs
// a little more than the one before, so that rounding does not choose between texels of one plane.
#define NEARER_FIRST 0x86207531u
#define LATER_COST 0.005f

__kernel void bilateral_upsample(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(lowNormalWs),
                                 SURFACE_IN(lowDepth), SURFACE_IN(lowIrradiance), SURFACE_OUT(outIrradiance),
                                 const BilateralUpsampleParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outIrradianceLayout)) return;
    vfloat3 irradiance = make3(0.0f, 0.0f, 0.0f);
    vfloat depth = load1(inDepth, px);
    vmask isSurface = depth > 0.0f;
    if (!anyLane(isSurface)) {
        store3(outIrradiance, px, irradiance);
        return;
    }
    const PickGrid grid = params.grid;
    const PickPoint point = pickPoint(&params.cameraRays, &grid, px, depth, load3(inNormalWs, px));
    const PickTaps taps = tapsAround(&grid, px, lowDepthLayout);

    vfloat sum = 0.0f;
    for (int i = 0; i < 4; ++i) {
        int next = i & 1, row = i >> 1;
        vfloat tapDepth = spreadTexels(loadTexels1(lowDepth, taps, row, next), &grid, next);
        vfloat3 tapNormalWs = spreadTexels3(loadTexels3(lowNormalWs, taps, row, next), &grid, next);
        TapMatch match = matchTap(&grid, &point, taps.x + next, taps.y[row], tapDepth, tapNormalWs);
        vfloat bilinear = taps.weightX[next] * (row ? taps.fractionY : 1.0f - taps.fractionY);
        vfloat plane = max(vmad(-match.planeTexels, match.planeTexels, 1.0f), 0.0f);
        vfloat cosine2 = match.cosine * match.cosine, cosine4 = cosine2 * cosine2;
        vfloat weight = vselect(match.isSurface, bilinear * plane * (cosine4 * cosine4), 0.0f);
        irradiance = mad3(weight, spreadTexels3(loadTexels3(lowIrradiance, taps, row, next), &grid, next), irradiance);
        sum += weight;
    }
    irradiance = scale3(1.0f / max(sum, MIN_WEIGHT), irradiance);

    vmask isLost = isSurface & (sum < MIN_WEIGHT);
    if (anyLane(isLost)) {
        vint nearX = vselectInt(taps.weightX[1] >= 0.5f, taps.x + 1, taps.x);
        nearX = clampInt(nearX, 0, lowDepthLayout.widthPx - 1);
        int nearY = taps.fractionY < 0.5f ? taps.y[0] : taps.y[1];
        vint bestX = nearX, bestY = (vint)(nearY);
        vfloat bestCost = 3.0f;  // more than any
        for (int i = 0; i < 9; ++i) {
            int j = i == 0 ? 4 : (int)((NEARER_FIRST >> (4 * (i - 1))) & 15u);
            vint x = clampInt(nearX + (j % 3 - 1), 0, lowDepthLayout.widthPx - 1);
            int y = min(max(nearY + (j / 3 - 1), 0), lowDepthLayout.heightPx - 1);
            TapMatch match = matchTap(&grid, &point, x, y, gather1(lowDepth, x, (vint)(y)),
                                      gather3(lowNormalWs, x, (vint)(y)));
            vfloat cost = match.planeTexels / (match.planeTexels + 1.0f) + (1.0f - match.cosine);
            cost += LATER_COST * (float)i;
            vmask isBetter = match.isSurface & (cost < bestCost);
            bestCost = vselect(isBetter, cost, bestCost);
            bestX = vselectInt(isBetter, x, bestX);
            bestY = vselectInt(isBetter, (vint)(y), bestY);
        }
        vfloat3 best = gather3(lowIrradiance, bestX, bestY);
        best = select3(bestCost < 3.0f, best, make3(0.0f, 0.0f, 0.0f));
        irradiance = select3(isLost, best, irradiance);
    }
    store3(outIrradiance, px, select3(isSurface, irradiance, make3(0.0f, 0.0f, 0.0f)));
}
