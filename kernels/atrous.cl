// atrous: one pass of the edge-avoiding a-trous filter: a mean over taps that lie on the same surface.
//   out(p) = sum_q k_q w(p, q) in(q) / sum_q k_q w(p, q),   q = p + stepPx (i, j), |i| <= radiusX, |j| <= radiusY
//   Dammertz et al. 2010. 5 x 5 and 3 x 3 are B-splines; the separable pair runs a row and a column one after the other.
//   w = fade max(0, 1 - t)^2,   t = (plane / reach)^2 + |n_p - n_q|^2 / normalTolerance + luminance (below)
//   plane: distance of q's point from p's plane; reach: depthTolerance times the way to q on the surface, so that neither
//   the scene's scale nor the step matters. All of it is polynomial: no transcendental a tap.
//   fade = min(1, fadeFrames / length): where history is long there is little noise left, and blur would be all error.
//   luminance: (l_p - l_q)^2 / (luminanceTolerance^2 variance of p's mean), coming in from 3 to 4 frames
//   (Schied et al. 2017); a hundredth of l_p is never an edge, nor could 32 bits tell its variance.
//   ATROUS_WEIGHTS_DEPTH is the field's usual weight, for comparison: e^(-|z_p - z_q| max(1/4, n_p.v) / (depthTolerance
//   |(i, j)|)) e^(-|n_p - n_q|^2 / normalTolerance), v towards the eye.
//   in   inIrradiance   lx
//   in   inNormalWs, inDepth   unit; m, 0 on sky
//   in   inLength       frames of history
//   in   inMoment       lx^2: mean squared luminance; if luminanceTolerance > 0
//   out  outIrradiance  lx, >= 0, finite; 0 on sky
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "atrous_params.h"
#include "geometry.clh"
#include "math.clh"
#include "surface.clh"

__kernel void atrous(SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(inLength),
                     SURFACE_IN(inMoment), SURFACE_OUT(outIrradiance), const AtrousParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outIrradianceLayout)) return;
    int width = outIrradianceLayout.widthPx, height = outIrradianceLayout.heightPx;
    vfloat depth = load1(inDepth, px);
    vmask isSurface = depth > 0.0f;
    if (!anyLane(isSurface)) {
        store3(outIrradiance, px, make3(0.0f, 0.0f, 0.0f));
        return;
    }
    vfloat3 normal = load3(inNormalWs, px);
    vfloat3 irradiance = load3(inIrradiance, px);
    vfloat length = load1(inLength, px);
    vfloat fade = min(params.fadeFrames / max(length, 1.0f), 1.0f);

    // q's distance from p's plane is n.(x_q - x_p); with x = origin + depth ray, both linear in the pixel, it comes down
    // to these dot products.
    const ViewRays* rays = &params.cameraRays;
    vfloat originX = dot3(normal, splat3(rays->originDx)), originY = dot3(normal, splat3(rays->originDy));
    vfloat rayX = dot3(normal, splat3(rays->rayDx)), rayY = dot3(normal, splat3(rays->rayDy));
    vfloat3 ray = mad3(toVfloat(px.x + laneIndex()), splat3(rays->rayDx),
                       mad3((vfloat)((float)px.y), splat3(rays->rayDy), splat3(rays->ray)));
    vfloat along = dot3(normal, ray);
    vfloat cosine = max(-along * rsqrt(dot3(ray, ray)), 0.25f);

    vfloat reach = params.depthTolerance * vmad(depth, params.footprintPerM, params.footprintM);
    vfloat inverseReach = 1.0f / max(reach, 1e-30f);
    float inverseNormal = 1.0f / params.normalTolerance;
    vfloat l = luminance(irradiance), inverseVariance = 0.0f;
    if (params.luminanceTolerance > 0.0f) {
        vfloat variance = max(load1(inMoment, px) - l * l, 0.0f) / max(length, 1.0f);
        vfloat range = params.luminanceTolerance * params.luminanceTolerance * variance;
        inverseVariance = min(max(length - 3.0f, 0.0f), 1.0f) / (range + 1e-4f * l * l + 1e-30f);
    }

    float centre = (params.radiusX > 0 ? params.kernel0 : 1.0f) * (params.radiusY > 0 ? params.kernel0 : 1.0f);
    vfloat sumWeights = centre;
    vfloat3 sum = scale3(sumWeights, irradiance);
    for (int j = -params.radiusY; j <= params.radiusY; ++j) {
        int dy = j * params.stepPx, y = px.y + dy;
        if (y < 0 || y >= height) continue;
        float kernelY = params.radiusY == 0 ? 1.0f : j == 0 ? params.kernel0 : abs(j) == 1 ? params.kernel1 : params.kernel2;
        for (int i = -params.radiusX; i <= params.radiusX; ++i) {
            int dx = i * params.stepPx, x = px.x + dx;
            if ((i == 0 && j == 0) || x + LANES <= 0 || x >= width) continue;
            float kernelX =
                params.radiusX == 0 ? 1.0f : i == 0 ? params.kernel0 : abs(i) == 1 ? params.kernel1 : params.kernel2;
            vfloat tapDepth = loadFrom1(inDepth, x, y);
            vfloat3 tapNormal = loadFrom3(inNormalWs, x, y);
            vfloat3 tap = loadFrom3(inIrradiance, x, y);
            vmask isThere = (x + laneIndex() >= 0) & (x + laneIndex() < width) & (tapDepth > 0.0f);
            vfloat3 turn = sub3(tapNormal, normal);
            vfloat weight;
            if (params.weights == ATROUS_WEIGHTS_PLANE) {
                vfloat plane = vmad(tapDepth, vmad((float)dx, rayX, vmad((float)dy, rayY, along)), -depth * along);
                plane = vmad((float)dx, originX, vmad((float)dy, originY, plane)) * inverseReach;
                float inverseWay2 = 1.0f / (float)(dx * dx + dy * dy);
                vfloat t = vmad(plane * plane, inverseWay2, dot3(turn, turn) * inverseNormal);
                vfloat dl = luminance(tap) - l;
                t = vmad(dl * dl, inverseVariance, t);
                weight = max(1.0f - t, 0.0f);
                weight *= weight;
            } else {
                float inverseWay = rsqrt((float)(i * i + j * j)) / params.depthTolerance;
                weight = es_exp(-fabs(tapDepth - depth) * cosine * inverseWay - dot3(turn, turn) * inverseNormal);
            }
            weight = vselect(isThere, kernelX * kernelY * fade * weight, 0.0f);
            sumWeights += weight;
            sum = mad3(weight, tap, sum);
        }
    }
    store3(outIrradiance, px, select3(isSurface, scale3(1.0f / sumWeights, sum), make3(0.0f, 0.0f, 0.0f)));
}
