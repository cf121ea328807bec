// atrous_pair: a row and a column of the separable a-trous filter in one pass: what atrous.cl makes with radius (2, 0) and
// then (0, 2), weights of planes, and luminance as no guide.
//   An item walks down a strip of columns, over rows that are a step apart, filters each row once, and holds the last five
//   for the columns. So each pixel is read once and written once, where two passes do so twice; and what a pixel's weights
//   start from (FilterPoint) is found once.
//   in   inIrradiance   lx
//   in   inNormalWs, inDepth   unit; m, 0 on sky
//   in   inLength       frames of history
//   out  outIrradiance  lx, >= 0, finite; 0 on sky
//   Work 2D: strips of ATROUS_PAIR_STRIP x LANES pixels; ATROUS_PAIR_ROWS rows, a step apart, of each remainder of the
//   step: remainders of the first rows first. Any local size, 1 x 1 of several lanes; items past the edge return.

#include "atrous.clh"

// A pixel as it was read; depth 0: there is none.
typedef struct ReadPixel {
    vfloat3 irradiance, normal;
    vfloat depth, length;
} ReadPixel;

// A pixel of a filtered row.
typedef struct RowPixel {
    FilterPoint point;
    vfloat3 irradiance;
} RowPixel;

#define INPUTS_IN SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth)
#define INPUTS_ARG SURFACE_ARG(inIrradiance), SURFACE_ARG(inNormalWs), SURFACE_ARG(inDepth)

static ReadPixel readPixel(INPUTS_IN, SURFACE_IN(inLength), Pixel px) {
    const vfloat3 zero3 = make3(0.0f, 0.0f, 0.0f);
    ReadPixel r = {zero3, zero3, 0.0f, 0.0f};
    if (px.y < 0 || px.y >= inDepthLayout.heightPx) return r;
    r.depth = load1(inDepth, px);
    r.normal = load3(inNormalWs, px);
    r.irradiance = load3(inIrradiance, px);
    r.length = load1(inLength, px);
    return r;
}

// The four taps aside, as steps.
static int wayOf(int tap) { return tap < 2 ? tap - 2 : tap - 1; }
static float shareOf(const AtrousParams* params, int way) { return abs(way) == 1 ? params->share1 : params->share2; }

// fade lets the taps in; the pixel itself counts whole.
static vfloat3 meanOf(const AtrousParams* params, vfloat fade, vfloat3 irradiance, vfloat3 sum, vfloat sumWeights) {
    sum = mad3(fade, sum, scale3(params->share0, irradiance));
    return scale3(1.0f / vmad(fade, sumWeights, params->share0), sum);
}

static RowPixel filterRow(INPUTS_IN, const AtrousParams* params, Pixel px, ReadPixel read) {
    vfloat inverseLength = 1.0f / max(read.length, 1.0f);
    RowPixel r = {filterPoint(params, px, read.depth, read.normal, inverseLength), read.irradiance};
    if (!anyLane((read.depth > 0.0f) & (r.point.fade > 0.0f))) return r;

    // All taps at once: what is close in the source is under way together.
    int width = inDepthLayout.widthPx, step = params->stepPx;
    vfloat depths[4];
    vfloat3 normals[4], irradiances[4];
#pragma unroll
    for (int tap = 0; tap < 4; ++tap) {
        int x = px.x + wayOf(tap) * step;
        depths[tap] = loadFrom1(inDepth, x, px.y);
        normals[tap] = loadFrom3(inNormalWs, x, px.y);
        irradiances[tap] = loadFrom3(inIrradiance, x, px.y);
    }
    vfloat slopeX = growth(&r.point, params->cameraRays.rayDx), offsetX = growth(&r.point, params->cameraRays.originDx);
    vfloat offset = -read.depth * r.point.slope, sumWeights = 0.0f;
    vfloat3 sum = make3(0.0f, 0.0f, 0.0f);
    bool isInner = px.x >= 2 * step && px.x + LANES + 2 * step <= width;
#pragma unroll
    for (int tap = 0; tap < 4; ++tap) {
        int i = wayOf(tap);
        vint x = px.x + i * step + laneIndex();
        vmask isThere = depths[tap] > 0.0f;
        if (LANES == 1 || !isInner) isThere &= (x >= 0) & (x < width);
        vfloat near = nearness(params, &r.point, vmad(slopeX, i, r.point.slope), vmad(offsetX, i, offset),
                               1.0f / (float)(i * i), depths[tap], normals[tap]);
        near = vselect(isThere, max(near, 0.0f), 0.0f);
        vfloat weight = shareOf(params, i) * near * near;
        sumWeights += weight;
        sum = mad3(weight, irradiances[tap], sum);
    }
    if (params->limitsLone) {
        vfloat luminances = 0.0f, taps = 0.0f, shares = 0.0f;
#pragma unroll
        for (int tap = 0; tap < 4; ++tap) {
            vint x = px.x + wayOf(tap) * step + laneIndex();
            vmask isInside = (x >= 0) & (x < width), isThere = isInside & (depths[tap] > 0.0f);
            luminances += vselect(isThere, luminance(irradiances[tap]), 0.0f);
            taps += vselect(isThere, 1.0f, 0.0f);
            shares += vselect(isInside, shareOf(params, wayOf(tap)), 0.0f);
        }
        r.irradiance =
            limitedAlone(r.irradiance, read.length, r.point.fade, sumWeights, shares, luminances, taps);
    }
    r.irradiance = meanOf(params, r.point.fade, r.irradiance, sum, sumWeights);
    return r;
}

// Of the third of five rows, a step apart. y of `height` is its row; length: read only if limitsLone.
static vfloat3 filterColumn(const RowPixel* above2, const RowPixel* above, const RowPixel* row, const RowPixel* below,
                            const RowPixel* below2, const AtrousParams* params, int y, int height, vfloat length) {
    const FilterPoint* p = &row->point;
    vmask isSurface = p->depth > 0.0f;
    vfloat3 mean = row->irradiance;
    if (anyLane(isSurface & (p->fade > 0.0f))) {
        const RowPixel* taps[4] = {above2, above, below, below2};
        vfloat slopeY = growth(p, params->cameraRays.rayDy), offsetY = growth(p, params->cameraRays.originDy);
        vfloat offset = -p->depth * p->slope, sumWeights = 0.0f;
        vfloat3 sum = make3(0.0f, 0.0f, 0.0f);
#pragma unroll
        for (int tap = 0; tap < 4; ++tap) {
            int j = wayOf(tap);
            const RowPixel* q = taps[tap];
            vfloat near = nearness(params, p, vmad(slopeY, j, p->slope), vmad(offsetY, j, offset),
                                   1.0f / (float)(j * j), q->point.depth, q->point.normal);
            near = vselect(q->point.depth > 0.0f, max(near, 0.0f), 0.0f);
            vfloat weight = shareOf(params, j) * near * near;
            sumWeights += weight;
            sum = mad3(weight, q->irradiance, sum);
        }
        if (params->limitsLone) {
            vfloat luminances = 0.0f, count = 0.0f;
            float shares = 0.0f;
#pragma unroll
            for (int tap = 0; tap < 4; ++tap) {
                vmask isThere = taps[tap]->point.depth > 0.0f;
                luminances += vselect(isThere, luminance(taps[tap]->irradiance), 0.0f);
                count += vselect(isThere, 1.0f, 0.0f);
                int at = y + wayOf(tap) * params->stepPx;
                if (at >= 0 && at < height) shares += shareOf(params, wayOf(tap));
            }
            mean = limitedAlone(mean, length, p->fade, sumWeights, shares, luminances, count);
        }
        mean = meanOf(params, p->fade, mean, sum, sumWeights);
    }
    return select3(isSurface, mean, make3(0.0f, 0.0f, 0.0f));
}

// Strips take stack, which CPU drivers keep for every item of a group: one item a group.
#if LANES > 1
__attribute__((reqd_work_group_size(1, 1, 1)))
#endif
__kernel void atrous_pair(SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(inLength),
                          SURFACE_OUT(outIrradiance), const AtrousParams params) {
    int width = outIrradianceLayout.widthPx, height = outIrradianceLayout.heightPx, step = params.stepPx;
    int left = (int)get_global_id(0) * (ATROUS_PAIR_STRIP(LANES) * LANES), item = (int)get_global_id(1);
    int top = item / step * step * ATROUS_PAIR_ROWS(LANES) + item % step;
    if (left >= width || top >= height) return;

#if LANES == 1
    // Five rows in registers, and the next one on its way while this one is filtered. What its taps will want is on its
    // way with it: they are other items' pixels.
    RowPixel row0, row1, row2, row3, row4;
    Pixel px = {left, top - 2 * step};
    ReadPixel next = readPixel(INPUTS_ARG, SURFACE_ARG(inLength), px);
    for (int row = -2; row < ATROUS_PAIR_ROWS(LANES) + 2; ++row, px.y += step) {
        ReadPixel read = next;
        Pixel below = {left, px.y + step}, out = {left, px.y - 2 * step};
        if (out.y >= height) return;
        next = readPixel(INPUTS_ARG, SURFACE_ARG(inLength), below);
        row0 = row1;
        row1 = row2;
        row2 = row3;
        row3 = row4;
        row4 = filterRow(INPUTS_ARG, &params, px, read);
        if (row < 2) continue;
        vfloat length = 0.0f;
        if (params.limitsLone) length = load1(inLength, out);
        store3(outIrradiance, out, filterColumn(&row0, &row1, &row2, &row3, &row4, &params, out.y, height, length));
    }
#else
    RowPixel rows[5][ATROUS_PAIR_STRIP(LANES)];  // row r is in r % 5
    for (int row = 0; row < ATROUS_PAIR_ROWS(LANES) + 4; ++row) {
        Pixel px = {left, top + (row - 2) * step};
        if (px.y - 2 * step >= height) return;
        for (int k = 0; k < ATROUS_PAIR_STRIP(LANES) && px.x < width; ++k, px.x += LANES)
            rows[row % 5][k] = filterRow(INPUTS_ARG, &params, px, readPixel(INPUTS_ARG, SURFACE_ARG(inLength), px));
        if (row < 4) continue;
        px.x = left;
        px.y -= 2 * step;
        for (int k = 0; k < ATROUS_PAIR_STRIP(LANES) && px.x < width; ++k, px.x += LANES) {
            vfloat length = 0.0f;
            if (params.limitsLone) length = load1(inLength, px);
            store3(outIrradiance, px,
                   filterColumn(&rows[(row + 1) % 5][k], &rows[(row + 2) % 5][k], &rows[(row + 3) % 5][k],
                                &rows[(row + 4) % 5][k], &rows[row % 5][k], &params, px.y, height, length));
        }
    }
#endif
}
