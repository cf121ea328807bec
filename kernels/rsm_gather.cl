// rsm_gather: one-bounce irradiance from a few texels of each light's RSM, in a disk around the point's own projection.
//   E(x) = sum_lights c/S sum_s  Phi_p(s) / pi G(p(s), x) / pdf(s)
//   c the light's indirectScale; G = max(0, n_p.(x - x_p)) max(0, n.(x_p - x)) / |x - x_p|^4, with the texel a small disc (rsm.clh)
//   Dachsbacher & Stamminger 2005, whose weights leave the pdf out. Ours: s lies in the disk of the given radius by the
//   pattern's pdf, so the mean is that of the full sum for any sample count and any radius that covers the map; beyond
//   the map's border is black, at no bias, since texels there have no flux. Each pixel shifts the pattern's radii and turns
//   it by blue noise (Cranley & Patterson 1976), so that what few samples miss becomes fine noise instead of bands. Each
//   frame moves all pixels' patterns on by the same step of a low-discrepancy sequence (frame_params.hpp), so that a mean
//   over frames converges as one long pattern does, and a single frame's noise stays blue.
//   Radii are r(u) of a uniform u, each with its pdf over the unit disk, (du/dr) / (2 pi r):
//     area     r = sqrt(u)   1 / pdf = pi
//     polar    r = u         1 / pdf = 2 pi u
//     squared  r = u^2       1 / pdf = 4 pi u^3: dense where most light comes from, the usual choice of games
//   in   inNormalWs     unit
//   in   inDepth        m; 0 on sky
//   in   rsm            all lights' maps below one another
//   in   lights         LightParams
//   in   pattern        sampleCount x (cos a, sin a, pi / S, u before its shift: s / S) in the unit disk
//   in   noise          three planes of 64 x 64: shift of u [0; 1), cosine and sine of a turn; repeats
//   out  outIrradiance  lx, >= 0, finite; 0 on sky
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "rsm.clh"
#include "rsm_gather_params.h"

__kernel void rsm_gather(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), RSM_IN(rsm),
                         __global const LightParams* restrict lights, __global const float4* restrict pattern,
                         __global const float* restrict noise, SURFACE_OUT(outIrradiance), const RsmGatherParams params) {
    Pixel px = itemPixel();
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
    float size = (float)params.rsmSizePx;

    vfloat shift = 0.5f / (float)params.sampleCount, cosTurn = params.frameTurnCos, sinTurn = params.frameTurnSin;
    if (params.rotates) {
        __global const float* from = noise + (px.y % ROTATION_NOISE_SIZE_PX) * ROTATION_NOISE_SIZE_PX +
                                     px.x % ROTATION_NOISE_SIZE_PX;
        shift = *(__global const vfloat*)from;
        vfloat cosNoise = *(__global const vfloat*)(from + ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX);
        vfloat sinNoise = *(__global const vfloat*)(from + 2 * ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX);
        cosTurn = cosNoise * params.frameTurnCos - sinNoise * params.frameTurnSin;
        sinTurn = cosNoise * params.frameTurnSin + sinNoise * params.frameTurnCos;
    }
    shift += params.frameShift;

    for (int l = 0; l < params.lightCount; ++l) {
        const LightParams light = lights[l];
        // The disk's centre stays on the map, wherever the point is: all that a farther centre could do is miss it.
        vfloat w = rowTimesPoint(light.wRow, positionWs);
        vfloat scale = size * params.mapScale / max(w, 1e-6f);
        vmask isAhead = w > 1e-6f;
        vfloat cx = vselect(isAhead, rowTimesPoint(light.uRow, positionWs) * scale, 0.5f * size);
        vfloat cy = vselect(isAhead, rowTimesPoint(light.vRow, positionWs) * scale, 0.5f * size);
        cx = min(max(cx, 0.0f), size);
        cy = min(max(cy, 0.0f), size);

        float radius = light.gatherRadiusUv > 0.0f ? light.gatherRadiusUv : params.radiusUv;
        vfloat3 sum = make3(0.0f, 0.0f, 0.0f);
        for (int s = 0; s < params.sampleCount; ++s) {
            float4 p = pattern[s];
            vfloat u = p.w + shift;
            u = u - floor(u);
            vfloat unitRadius, weight = p.z;
            if (params.mapping == MAPPING_AREA) {
                unitRadius = sqrt(u);
            } else if (params.mapping == MAPPING_POLAR) {
                unitRadius = u;
                weight *= 2.0f * u;
            } else {
                unitRadius = u * u;
                weight *= 4.0f * u * unitRadius;
            }
            vfloat r = radius * size * unitRadius;
            vfloat fx = vmad(r, p.x * cosTurn - p.y * sinTurn, cx);
            vfloat fy = vmad(r, p.x * sinTurn + p.y * cosTurn, cy);
            vmask isInside = (fx >= 0.0f) & (fx < size) & (fy >= 0.0f) & (fy < size);
            vint x = vselectInt(isInside, toVint(fx), 0);
            vint y = vselectInt(isInside, toVint(fy), 0) + l * params.rsmSizePx;
            RsmTexel t = rsmGather(rsm, x, y, params.rsmSizePx, &light);
            vfloat g = texelGeometry(positionWs, normalWs, t.positionWs, t.normalWs, t.radius);
            sum = mad3(vselect(isInside, g * weight, 0.0f), t.flux, sum);
        }
        // A sample at density pdf over the disk of radius r stands for r^2 / pdf of the unit square of N x N texels.
        irradiance = mad3((vfloat)(light.indirectScale * radius * radius * size * size * ES_INV_PI), sum, irradiance);
    }
    store3(outIrradiance, px, select3(isSurface, irradiance, make3(0.0f, 0.0f, 0.0f)));
}
