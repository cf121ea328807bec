// rsm_gather: one-bounce irradiance from a few texels of each light's RSM, in a disk around the point's own projection.
//   E(x) = sum_lights c/S sum_s  Phi_p(s) / pi G(p(s), x) / pdf(s)
//   c the light's indirectScale; G = max(0, n_p.(x - x_p)) max(0, n.(x_p - x)) / |x - x_p|^4, with the texel a small disc (rsm.clh)
//   Dachsbacher & Stamminger 2005, whose weights leave the pdf out. Ours: s lies in the disk of the given radius by the
//   pattern's pdf, so the mean is that of the full sum for any sample count and any radius that covers the map; beyond
//   the map's border is black, at no bias, since texels there have no flux. Each pixel shifts the pattern's radii and turns
//   it by blue noise (Cranley & Patterson 1976), so that what few samples miss becomes fine noise instead of bands; or
//   it turns it by one of 16 angles, whose mean tile_average.cl takes over 4 x 4 pixels. Each frame moves all pixels'
//   patterns on by the same step of a low-discrepancy sequence (frame_params.hpp), so that a mean over frames converges
//   as one long pattern does, and a single frame's noise stays blue.
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
#include "rsm_gather.clh"

__kernel void rsm_gather(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), RSM_IN(rsm),
                         __global const LightParams* restrict lights, __global const float4* restrict pattern,
                         __global const float* restrict noise, SURFACE_OUT(outIrradiance), const RsmGatherParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outIrradianceLayout)) return;
    // One store for sky and surface: of two, LLVM makes one that has forgotten to go past the caches.
    vfloat3 irradiance = make3(0.0f, 0.0f, 0.0f);
    vfloat depth = load1(inDepth, px);
    vmask isSurface = depth > 0.0f;
    if (anyLane(isSurface)) {
        vfloat3 normalWs = load3(inNormalWs, px);
        vfloat3 positionWs = positionFromDepth(&params.cameraRays, px.x + laneIndex(), (vint)(px.y), depth);

        vfloat shift = 0.5f / (float)params.sampleCount, cosOwn = 1.0f, sinOwn = 0.0f;
        if (ROTATION == ROTATION_NOISE) {
            __global const float* from = noise + (px.y % ROTATION_NOISE_SIZE_PX) * ROTATION_NOISE_SIZE_PX +
                                         px.x % ROTATION_NOISE_SIZE_PX;
            shift = *(__global const vfloat*)from;
            cosOwn = *(__global const vfloat*)(from + ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX);
            sinOwn = *(__global const vfloat*)(from + 2 * ROTATION_NOISE_SIZE_PX * ROTATION_NOISE_SIZE_PX);
        } else if (ROTATION == ROTATION_TILE) {
            vfloat turn = tileTurn(px.x + laneIndex(), (vint)(px.y));
            cosOwn = es_cosTau(turn);
            sinOwn = es_sinTau(turn);
        }
        irradiance = diskIrradiance(RSM_ARG(rsm), lights, pattern, &params,
                                    patternMove(&params, shift, cosOwn, sinOwn), positionWs, normalWs);
        irradiance = select3(isSurface, irradiance, make3(0.0f, 0.0f, 0.0f));
    }
    store3(outIrradiance, px, irradiance);
}
