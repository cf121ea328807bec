// direct_light: irradiance straight from directional and spot lights, each behind a hard shadow map.
//   E(x) = sum_lights V E_perp max(0, n.l)                          directional
//        = sum_lights V I f(angle) g(|d|) max(0, n.l) / |d|^2       spot; falloffs of KHR_lights_punctual
//   V: the point is no deeper than the map's nearest texel, plus a bias of (constant + slope x tan(angle to n)) texels,
//   so that it needs no constant of the scene's scale; n is the mapped normal, so a strong normal map may want a larger
//   constant. Outside the map nothing casts a shadow.
//   Williams 1978, "Casting Curved Shadows on Curved Surfaces".
//   in   inNormalWs     unit
//   in   inDepth        m; 0 on sky
//   in   shadowDepth    all lights' shadow maps below one another: m along the light's -z; 0 = nothing
//   in   lights         LightParams
//   out  outIrradiance  lx, >= 0, finite; 0 on sky
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "direct_light_params.h"
#include "geometry.clh"
#include "math.clh"
#include "surface.clh"

// What the light sends through a plane across its ray at x, per unit of intensity; *towards gets the unit way to it.
static vfloat incident(const LightParams* light, vfloat3 positionWs, vfloat3* towards) {
    *towards = splat3(light->towardsLight);
    if (light->type == LIGHT_DIRECTIONAL) return 1.0f;
    vfloat3 d = sub3(splat3(light->positionWs), positionWs);
    vfloat d2 = max(dot3(d, d), 1e-12f);
    vfloat inverse = rsqrt(d2);
    vfloat cosAxis = dot3(d, *towards) * inverse;
    *towards = scale3(inverse, d);
    vfloat cone = min(max(vmad(cosAxis, light->coneScale, light->coneOffset), 0.0f), 1.0f);
    vfloat q = d2 * light->inverseRange * light->inverseRange;
    vfloat window = min(max(1.0f - q * q, 0.0f), 1.0f);
    return cone * cone * window / d2;
}

__kernel void direct_light(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(shadowDepth),
                           __global const LightParams* restrict lights, SURFACE_OUT(outIrradiance),
                           const DirectLightParams params) {
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
    float width = (float)params.shadowWidthPx, height = (float)params.shadowHeightPx;

    for (int l = 0; l < params.lightCount; ++l) {
        const LightParams light = lights[l];
        vfloat3 towards;
        vfloat e = incident(&light, positionWs, &towards);
        vfloat cosine = dot3(normalWs, towards);

        vfloat w = rowTimesPoint(light.wRow, positionWs);
        vfloat inverseW = 1.0f / max(w, 1e-6f);
        vfloat fx = rowTimesPoint(light.uRow, positionWs) * inverseW * width;
        vfloat fy = rowTimesPoint(light.vRow, positionWs) * inverseW * height;
        vmask isOnMap = (w > 1e-6f) & (fx >= 0.0f) & (fx < width) & (fy >= 0.0f) & (fy < height);
        vint x = vselectInt(isOnMap, toVint(fx), 0);
        vint y = vselectInt(isOnMap, toVint(fy), 0) + l * params.shadowHeightPx;
        vfloat occluderDepth = gather1(shadowDepth, x, y);

        vfloat depthInLight = rowTimesPoint(light.depthRow, positionWs);
        vfloat texelSize = light.type == LIGHT_SPOT ? light.shadowTexelSize * depthInLight : light.shadowTexelSize;
        // tan of the angle between normal and light, cut where a surface is all but edge-on.
        vfloat slope = min(sqrt(max(1.0f - cosine * cosine, 0.0f)) / max(cosine, 0.02f), 20.0f);
        vfloat bias = texelSize * vmad(params.shadowSlopeBiasTexels, slope, params.shadowBiasTexels);
        vmask isShadowed = isOnMap & (occluderDepth > 0.0f) & (depthInLight > occluderDepth + bias);

        e = vselect(isShadowed, 0.0f, e * max(cosine, 0.0f));
        irradiance = mad3(e, splat3(light.intensity), irradiance);
    }
    store3(outIrradiance, px, select3(isSurface, irradiance, make3(0.0f, 0.0f, 0.0f)));
}
