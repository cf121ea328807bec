// interpolate: irradiance of a lower resolution where it may be interpolated, and a list of the pixels where not.
//   Dachsbacher & Stamminger 2005, section 3.4: a texel is suitable if its normal is similar to the pixel's and its
//   location is close; where three or four of the 2 x 2 around a pixel are suitable, the pixel is their bilinear mean,
//   and elsewhere it is evaluated in full (rsm_gather_list.cl).
//   Ours: close is near the pixel's plane, in widths of a texel (pick_grid.clh), not near its point: that would
//   evaluate every floor that runs away from the camera. And only texels that carry weight are asked, of which at least
//   three in four must be suitable: a pixel that was picked itself always is, and one between two needs both.
//   in   inNormalWs, inDepth     the full picture: unit; m, 0 on sky
//   in   lowNormalWs, lowDepth   the picked one, by downsample
//   in   lowIrradiance           lx
//   out  outIrradiance   lx, finite; 0 on sky and where the pixel is on the list
//   out  outPixels       y width + x of each pixel to evaluate, in any order; room for every pixel
//   out  outCount        how many: an int that was 0
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "interpolate_params.h"
#include "pick_grid.clh"

__kernel void interpolate(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(lowNormalWs), SURFACE_IN(lowDepth),
                          SURFACE_IN(lowIrradiance), SURFACE_OUT(outIrradiance), __global int* restrict outPixels,
                          __global int* restrict outCount, const InterpolateParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outIrradianceLayout)) return;
    vfloat3 irradiance = make3(0.0f, 0.0f, 0.0f);
    vfloat depth = load1(inDepth, px);
    vmask isSurface = (depth > 0.0f) & (px.x + laneIndex() < outIrradianceLayout.widthPx);
    if (!anyLane(isSurface)) {
        store3(outIrradiance, px, irradiance);
        return;
    }
    const PickGrid grid = params.grid;
    const PickPoint point = pickPoint(&params.cameraRays, &grid, px, depth, load3(inNormalWs, px));
    const PickTaps taps = tapsAround(&grid, px, lowDepthLayout);

    vfloat sum = 0.0f, asked = 0.0f, suitable = 0.0f;
    for (int i = 0; i < 4; ++i) {
        int next = i & 1, row = i >> 1;
        vfloat tapDepth = spreadTexels(loadTexels1(lowDepth, taps, row, next), &grid, next);
        vfloat3 tapNormalWs = spreadTexels3(loadTexels3(lowNormalWs, taps, row, next), &grid, next);
        TapMatch match = matchTap(&grid, &point, taps.x + next, taps.y[row], tapDepth, tapNormalWs);
        vfloat bilinear = taps.weightX[next] * (row ? taps.fractionY : 1.0f - taps.fractionY);
        vmask isSuitable = match.isSurface & (match.planeTexels <= params.maxPlaneTexels) &
                           (match.cosine >= params.minCosine);
        vfloat weight = vselect(isSuitable, bilinear, 0.0f);
        irradiance = mad3(weight, spreadTexels3(loadTexels3(lowIrradiance, taps, row, next), &grid, next), irradiance);
        sum += weight;
        asked += vselect(bilinear > 0.0f, 1.0f, 0.0f);
        suitable += vselect(weight > 0.0f, 1.0f, 0.0f);
    }
    vmask isInterpolated = isSurface & (sum > 0.0f) & (4.0f * suitable >= 3.0f * asked);
    irradiance = scale3(1.0f / max(sum, 1e-6f), irradiance);
    store3(outIrradiance, px, select3(isInterpolated, irradiance, make3(0.0f, 0.0f, 0.0f)));

    VintLanes isListed;
    isListed.v = isSurface & !isInterpolated;
    if (!anyLane(isListed.v)) return;
    int count = 0;
    for (int i = 0; i < LANES; ++i) count += isListed.lane[i] != 0;
    int at = atomic_add(outCount, count);
    for (int i = 0; i < LANES; ++i)
        if (isListed.lane[i]) outPixels[at++] = px.y * outIrradianceLayout.widthPx + px.x + i;
}
