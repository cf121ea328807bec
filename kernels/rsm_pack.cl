// rsm_pack: the RSM's three maps into one 32-byte record a texel, once a frame, so that the gather fetches once a sample.
//   in   inDepth     m along the light's -z, > 0; 0 where the light meets nothing
//   in   inNormalWs  unit
//   in   inFlux      lm, >= 0
//   in   lights      LightParams, one a map
//   out  outRecords  RsmRecord, rows of sizePx; flux 0 where the light meets nothing
//   Work 2D, one item per LANES texels of a row, over all maps below one another; items past the edge return.

#include "rsm.clh"

static uint snorm16(float v) { return (uint)(int)rint(clamp(v, -1.0f, 1.0f) * 32767.0f) & 0xffffu; }

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

    VfloatLanes x, y, z, nx, ny, nz, r, g, b, a;
    x.v = positionWs.x;
    y.v = positionWs.y;
    z.v = positionWs.z;
    nx.v = normalWs.x;
    ny.v = normalWs.y;
    nz.v = normalWs.z;
    r.v = flux.x;
    g.v = flux.y;
    b.v = flux.z;
    a.v = radius;
    for (int i = 0; i < min(LANES, params.sizePx - px.x); ++i) {
        RsmRecord record;
        record.positionX = x.lane[i];
        record.positionY = y.lane[i];
        record.positionZ = z.lane[i];
        record.fluxR = r.lane[i];
        record.fluxG = g.lane[i];
        record.fluxB = b.lane[i];
        record.normalXy = snorm16(nx.lane[i]) | snorm16(ny.lane[i]) << 16;
        // The radius as a half, rounded to nearest: 2^-112 of it has a half's bits at 13.
        record.normalZRadius = snorm16(nz.lane[i]) | ((as_uint(a.lane[i] * 0x1p-112f) + 0x1000u) >> 13) << 16;
        outRecords[px.y * params.sizePx + px.x + i] = record;
    }
}
