// rsm_gather_list: rsm_gather at the pixels of a list alone: what interpolate.cl leaves to be evaluated in full.
//   A list, not a mask: pixels that need it lie along edges, a few in a row of 16, and lanes of a list are all at work.
//   in   inNormalWs, inDepth, rsm, lights, pattern, noise   as rsm_gather.cl
//   in   pixels         y width + x of each pixel, each once, none of them sky
//   in   count          how many
//   out  outIrradiance  lx, >= 0, finite, at the pixels of the list; the others stay
//   Work 2D, one item per LANES pixels of the list, any local size; items past its end return, so that as many as for
//   all pixels will do where the host does not know the count.

#include "rsm.clh"
#include "rsm_gather.clh"

__kernel void rsm_gather_list(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), RSM_IN(rsm),
                              __global const LightParams* restrict lights, __global const float4* restrict pattern,
                              __global const float* restrict noise, __global const int* restrict pixels,
                              __global const int* restrict count, SURFACE_OUT(outIrradiance),
                              const RsmGatherParams params) {
    int first = (int)(get_global_id(1) * get_global_size(0) + get_global_id(0)) * LANES;
    if (first >= *count) return;
    VintLanes pixel;
    for (int i = 0; i < LANES; ++i) pixel.lane[i] = pixels[min(first + i, *count - 1)];  // past its end: the last again
    vint y = pixel.v / outIrradianceLayout.widthPx, x = pixel.v - y * outIrradianceLayout.widthPx;
    vfloat3 positionWs = positionFromDepth(&params.cameraRays, x, y, gather1(inDepth, x, y));

    VfloatLanes shift, cosOwn, sinOwn;
    shift.v = 0.5f / (float)params.sampleCount;
    cosOwn.v = 1.0f;
    sinOwn.v = 0.0f;
    if (ROTATION == ROTATION_NOISE) {
        VintLanes texel;
        texel.v = y % ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX + x % ROTATION_NOISE_SIZE_PX;
        for (int i = 0; i < LANES; ++i) {
            __global const float* from = noise + texel.lane[i];
            shift.lane[i] = from[0];
            cosOwn.lane[i] = from[ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX];
            sinOwn.lane[i] = from[2 * ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX];
        }
    } else if (ROTATION == ROTATION_TILE) {
        vfloat turn = tileTurn(x, y);
        cosOwn.v = es_cosTau(turn);
        sinOwn.v = es_sinTau(turn);
    }
    vfloat3 irradiance = diskIrradiance(RSM_ARG(rsm), lights, pattern, &params,
                                        patternMove(&params, shift.v, cosOwn.v, sinOwn.v), positionWs,
                                        gather3(inNormalWs, x, y));
    scatter3(outIrradiance, x, y, irradiance);
}
