// rsm_pack: the RSM's three maps into one 32-byte record a texel, once a frame, so that the gather fetches once a sample.
//   in   inDepth     m along the light's -z, > 0; 0 where the light meets nothing
//   in   inNormalWs  unit
//   in   inFlux      lm, >= 0
//   in   lights      LightParams, one a map
//   out  outRecords  RsmRecord, rows of sizePx; flux 0 where the light meets nothing
//   Work 2D, one item per LANES texels of a row, over all maps below one another; items past the edge return.

#include "rsm.clh"
#include "rsm_record.clh"

__kernel void rsm_pack(SURFACE_IN(inDepth), SURFACE_IN(inNormalWs), SURFACE_IN(inFlux),
                       __global const LightParams* restrict lights, __global RsmRecord* restrict outRecords,
                       const RsmPackParams params) {
    Pixel px = itemPixel();
    if (px.x >= params.sizePx || px.y >= params.sizePx * params.lightCount) return;
    const LightParams light = lights[px.y / params.sizePx];

    vfloat depth = load1(inDepth, px);
    vfloat3 normalWs = load3(inNormalWs, px);
    vfloat3 flux = load3(inFlux, px);
    vmask isHit = depth > 0.0f;
    flux = select3(isHit, make3(max(flux.x, 0.0f), max(flux.y, 0.0f), max(flux.z, 0.0f)), splat3((float4)(0.0f)));
    vfloat3 positionWs = positionFromDepth(&light.rsmRays, px.x + laneIndex(), (vint)(px.y % params.sizePx), depth);
    vfloat radius = vselect(isHit, min(texelRadius(&light, positionWs, normalWs, depth), 60000.0f), 0.0f);
    storeRecords(outRecords + px.y * params.sizePx + px.x, params.sizePx - px.x, positionWs, normalWs, flux, radius);
}
