// rsm_gather_coherent: one-bounce irradiance from the texels that rsm_choose.cl chose for each set of pixels.
//   E(x) = sum_chosen W(p) Phi_p G(p, x), G as in rsm_gather
//   All lanes read the same texels, so that a sample is no gather: on a CPU one load and arithmetic alone, on a GPU a
//   broadcast to neighbouring work-items.
//   in   inNormalWs, inDepth, rsm, lights   as rsm_gather.cl
//   in   choices        rsm_choose's outChoices of the same rows
//   out  outIrradiance  lx, >= 0, finite; 0 on sky
//   Work 2D, one item per 4 LANES pixels of a row, LANES of each of four sets; with LANES 1, one item per pixel; any
//   local size; items past the edge return.

#include "interleave_rows.clh"
#include "rsm.clh"
#include "rsm_choose_params.h"

// The lights' sum at LANES pixels of one set.
static vfloat3 setIrradiance(RSM_IN(rsm), __global const LightParams* restrict lights,
                             __global const RsmChoice* restrict choices, int lightStride, const RsmGatherParams* params,
                             vfloat3 positionWs, vfloat3 normalWs) {
    vfloat3 irradiance = make3(0.0f, 0.0f, 0.0f);
    for (int l = 0; l < params->lightCount; ++l) {
        const LightParams light = lights[l];
        for (int s = 0; s < params->sampleCount; ++s) {
            RsmChoice choice = choices[l * lightStride + s];
            RsmTexel t = rsmUniformAt(rsm, choice.texel, params->rsmSizePx, &light);
            vfloat g = texelGeometry(positionWs, normalWs, t.positionWs, t.normalWs, t.radius);
            irradiance = mad3(g * choice.weight, t.flux, irradiance);
        }
    }
    return irradiance;
}

__kernel void rsm_gather_coherent(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), RSM_IN(rsm),
                                  __global const LightParams* restrict lights,
                                  __global const RsmChoice* restrict choices, SURFACE_OUT(outIrradiance),
                                  const RsmChooseParams params) {
    const int classes = LANES == 1 ? 1 : COHERENT_STRIDE_PX;
    int firstX = (int)get_global_id(0) * LANES * classes, row = (int)get_global_id(1);
    if (firstX >= outIrradianceLayout.widthPx || row >= params.rowCount) return;
    int y = params.firstRowPx + row;
    int spans = (inDepthLayout.widthPx + COHERENT_SPAN_PX - 1) / COHERENT_SPAN_PX;
    int firstSet = (row * spans + firstX / COHERENT_SPAN_PX) * COHERENT_STRIDE_PX;
    int lightStride = params.rowCount * spans * COHERENT_STRIDE_PX * params.gather.sampleCount;
    vfloat3 irradiance[COHERENT_STRIDE_PX];
    for (int i = 0; i < classes; ++i) {  // pixels firstX + i + 4 lane
        int x = firstX + i;
        vfloat depth = pickRow1(SURFACE_ARG(inDepth), 2, x, y);
        vfloat3 normalWs = pickRow3(SURFACE_ARG(inNormalWs), 2, x, y);
        vint xs = x + COHERENT_STRIDE_PX * laneIndex();
        vfloat3 positionWs = positionFromDepth(&params.gather.cameraRays, xs, (vint)(y), depth);
        int set = firstSet + (x & (COHERENT_STRIDE_PX - 1));
        irradiance[i] = setIrradiance(RSM_ARG(rsm), lights, choices + set * params.gather.sampleCount, lightStride,
                                      &params.gather, positionWs, normalWs);
        irradiance[i] = select3(depth > 0.0f, irradiance[i], make3(0.0f, 0.0f, 0.0f));
    }
    Pixel px = {firstX, y};
    storeInterleaved3(outIrradiance, px, irradiance);
}
