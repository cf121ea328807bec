// rsm_sum: one-bounce irradiance from every texel of each light's RSM. Slow, exact: what estimators are measured against.
//   E(x) = sum_lights c sum_p Phi_p / pi G(p, x), G as in rsm_gather, c the light's indirectScale
//   in   inNormalWs     unit
//   in   inDepth        m; 0 on sky
//   in   rsm            all lights' maps below one another
//   in   lights         LightParams
//   out  outIrradiance  lx, >= 0, finite; 0 on sky
//   Work 2D, one item per LANES pixels of a row from firstRowPx on, any local size; items past the edge return. The host
//   launches bands of rows, so that progress shows and launches stay short.

#include "rsm.clh"
#include "rsm_sum_params.h"

__kernel void rsm_sum(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), RSM_IN(rsm),
                      __global const LightParams* restrict lights, SURFACE_OUT(outIrradiance),
                      const RsmSumParams params) {
    Pixel px = itemPixel();
    px.y += params.firstRowPx;
    if (isOutside(px, outIrradianceLayout)) return;
    vfloat3 irradiance = make3(0.0f, 0.0f, 0.0f);
    vfloat depth = load1(inDepth, px);
    vmask isSurface = depth > 0.0f;
    if (!anyLane(isSurface)) {
        store3(outIrradiance, px, irradiance);
        return;
    }
    vfloat3 normalWs = load3(inNormalWs, px);
    vfloat3 positionWs = positionFromDepth(&params.cameraRays, px.x + laneIndex(), (vint)(px.y), depth);

    for (int l = 0; l < params.lightCount; ++l) {
        const LightParams light = lights[l];
        for (int y = l * params.rsmSizePx; y < (l + 1) * params.rsmSizePx; ++y) {
            // A sum a row keeps small numbers from being lost in a large one.
            vfloat3 row = make3(0.0f, 0.0f, 0.0f);
            for (int x = 0; x < params.rsmSizePx; ++x) {
                RsmTexel t = rsmUniform(rsm, x, y, params.rsmSizePx, &light);
                vfloat g = texelGeometry(positionWs, normalWs, t.positionWs, t.normalWs, t.radius);
                row = mad3(g, t.flux, row);
            }
            irradiance = mad3((vfloat)(light.indirectScale), row, irradiance);
        }
    }
    irradiance = scale3((vfloat)(ES_INV_PI), irradiance);
    store3(outIrradiance, px, select3(isSurface, irradiance, make3(0.0f, 0.0f, 0.0f)));
}
