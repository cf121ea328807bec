// atrous: one pass of the edge-avoiding a-trous filter: a mean over taps that lie on the same surface.
//   out(p) = sum_q k_q w(p, q) in(q) / sum_q k_q w(p, q),   q = p + stepPx (i, j) of each tap
//   Dammertz et al. 2010. 5 x 5 and 3 x 3 are B-splines; the separable pair runs a row and a column one after the other.
//   w: common/atrous.clh, by planes; or ATROUS_WEIGHTS_DEPTH, the field's usual weight, for comparison:
//   fade e^(-|z_p - z_q| max(1/4, n_p.v) / (depthTolerance |(i, j)|)) e^(-2 (1 - n_p.n_q) / normalTolerance), v towards the eye
//   in   inIrradiance   lx
//   in   inNormalWs, inDepth   unit; m, 0 on sky
//   in   inLength       frames of history
//   in   inMoment       lx^2: mean squared luminance; if luminanceTolerance > 0
//   out  outIrradiance  lx, >= 0, finite; 0 on sky
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "atrous.clh"
#include "math.clh"
#include "surface.clh"

// Item i's row, of planes: those that are a multiple of `step` apart follow one another, so that a column's taps are rows
// that were just read, however far apart they lie (at step 4: 0.7 of the time on a CPU). Images keep blocks together.
static int rowOf(int i, int height, int step) {
    int rows = height / step, longer = height % step;  // of each remainder; the first `longer` have a row more
    int split = longer * (rows + 1);
    if (i < split) return i / (rows + 1) + i % (rows + 1) * step;
    return longer + (i - split) / rows + (i - split) % rows * step;
}

// Of a tap i steps away in a dimension with this many on each side. (No table: Mesa 22.3's rusticl crashes on an array in
// a kernel's argument that is read at a place known at run time only.)
static float shareOf(const AtrousParams* params, int i, int radius) {
    return radius == 0 ? 1.0f : i == 0 ? params->share0 : abs(i) == 1 ? params->share1 : params->share2;
}

__kernel void atrous(SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(inLength),
                     SURFACE_IN(inMoment), SURFACE_OUT(outIrradiance), const AtrousParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outIrradianceLayout)) return;
    int width = outIrradianceLayout.widthPx, height = outIrradianceLayout.heightPx;
    if (STORAGE == STORAGE_PLANAR && params.radiusY > 0 && params.stepPx > 1) px.y = rowOf(px.y, height, params.stepPx);
    vfloat depth = load1(inDepth, px);
    vmask isSurface = depth > 0.0f;
    if (!anyLane(isSurface)) {
        store3(outIrradiance, px, make3(0.0f, 0.0f, 0.0f));
        return;
    }
    vfloat3 irradiance = load3(inIrradiance, px);
    vfloat length = load1(inLength, px), inverseLength = 1.0f / max(length, 1.0f);
    if (!anyLane(isSurface & (fadeOf(&params, inverseLength) > 0.0f))) {
        store3(outIrradiance, px, irradiance);  // 0 on sky already
        return;
    }
    const ViewRays* rays = &params.cameraRays;
    vfloat3 normal = load3(inNormalWs, px);
    FilterPoint p = filterPoint(&params, px, depth, normal, inverseLength);
    vfloat slope = p.slope, offset = -depth * slope;
    vfloat slopeX = 0.0f, slopeY = 0.0f, offsetX = 0.0f, offsetY = 0.0f;
    if (params.radiusX > 0) {
        slopeX = growth(&p, rays->rayDx);
        offsetX = growth(&p, rays->originDx);
        slope -= (float)params.radiusX * slopeX;
        offset -= (float)params.radiusX * offsetX;
    }
    if (params.radiusY > 0) {
        slopeY = growth(&p, rays->rayDy);
        offsetY = growth(&p, rays->originDy);
        slope -= (float)params.radiusY * slopeY;
        offset -= (float)params.radiusY * offsetY;
    }
    vfloat l = luminance(irradiance), inverseVariance = 0.0f;
    if (params.luminanceTolerance > 0.0f) {
        vfloat variance = max(load1(inMoment, px) - l * l, 0.0f) * inverseLength;
        vfloat range = params.luminanceTolerance * params.luminanceTolerance * variance;
        inverseVariance = min(max(length - 3.0f, 0.0f), 1.0f) / (range + 1e-4f * l * l + 1e-30f);
    }
    vfloat cosine = 1.0f;
    if (params.weights == ATROUS_WEIGHTS_DEPTH) {
        vfloat3 ray = viewRay(&params, px);
        cosine = max(-dot3(normal, ray) * rsqrt(dot3(ray, ray)), 0.25f);
    }

    int spanPx = params.radiusX * params.stepPx;
    bool isInner = px.x >= spanPx && px.x + LANES + spanPx <= width;
    vfloat sumWeights = 0.0f, luminances = 0.0f, taps = 0.0f, shares = 0.0f;
    vfloat3 sum = make3(0.0f, 0.0f, 0.0f);
    for (int j = -params.radiusY; j <= params.radiusY; ++j, slope += slopeY, offset += offsetY) {
        int y = px.y + j * params.stepPx;
        float shareJ = shareOf(&params, j, params.radiusY);
        vfloat slopeI = slope, offsetI = offset;
        for (int i = -params.radiusX; i <= params.radiusX; ++i, slopeI += slopeX, offsetI += offsetX) {
            int x = px.x + i * params.stepPx;
            if ((i == 0 && j == 0) || y < 0 || y >= height || x + LANES <= 0 || x >= width) continue;
            float inverseWay2 = 1.0f / (float)(i * i + j * j);
            vfloat tapDepth = loadFrom1(inDepth, x, y);
            vfloat3 tap = loadFrom3(inIrradiance, x, y), tapNormal = loadFrom3(inNormalWs, x, y);
            vmask isInside = (x + laneIndex() >= 0) & (x + laneIndex() < width), isThere = tapDepth > 0.0f;
            if (!isInner) isThere &= isInside;
            float share = shareJ * shareOf(&params, i, params.radiusX);
            vfloat weight, tapL = luminance(tap);
            if (params.limitsLone) {
                luminances += vselect(isThere, tapL, 0.0f);
                taps += vselect(isThere, 1.0f, 0.0f);
                shares += vselect(isInside, share, 0.0f);
            }
            if (params.weights == ATROUS_WEIGHTS_PLANE) {
                vfloat near = nearness(&params, &p, slopeI, offsetI, inverseWay2, tapDepth, tapNormal);
                vfloat dl = tapL - l;
                near = max(vmad(-dl * dl, inverseVariance, near), 0.0f);
                weight = near * near;
            } else {
                float inverseWay = sqrt(inverseWay2) / params.depthTolerance;
                vfloat like = min(normalLikeness(&params, &p, tapNormal), 1.0f);
                weight = es_exp(-fabs(tapDepth - depth) * cosine * inverseWay + like - 1.0f);
            }
            weight = vselect(isThere, share * weight, 0.0f);
            sumWeights += weight;
            sum = mad3(weight, tap, sum);
        }
    }
    float centre = shareOf(&params, 0, params.radiusX) * shareOf(&params, 0, params.radiusY);
    if (params.limitsLone) irradiance = limitedAlone(irradiance, length, p.fade, sumWeights, shares, luminances, taps);
    sumWeights = vmad(p.fade, sumWeights, centre);
    sum = mad3(p.fade, sum, scale3(centre, irradiance));
    store3(outIrradiance, px, select3(isSurface, scale3(1.0f / sumWeights, sum), make3(0.0f, 0.0f, 0.0f)));
}
