// atrous_pair: a row and a column of the separable a-trous filter in one pass: what atrous.cl makes with radius (2, 0) and
// then (0, 2), weights of planes, and luminance as no guide.
//   An item walks down a strip of columns, over rows that are a step apart, filters each row once, and holds the last five
//   for the columns. So each pixel is read once and written once, where two passes do so twice; and what a pixel's weights
//   start from (FilterPoint) is found once.
//   With LANES 1 a group is a piece of a row: its items share, in local memory, what their taps want, decoded once; and
//   the next row is on its way, undecoded, while this one is filtered.
//   in   inIrradiance   lx
//   in   inNormalWs, inDepth   unit; m, 0 on sky
//   in   inLength       frames of history
//   out  outIrradiance  lx, >= 0, finite; 0 on sky
//   Work 2D: strips of ATROUS_PAIR_STRIP x LANES pixels; params.pairRows rows, a step apart, of each remainder of the
//   step: remainders of the first rows first. Groups of ATROUS_PAIR_GROUP; items past the edge write nothing.

#include "atrous.clh"

#ifndef LIMITS_LONE
#define LIMITS_LONE 1  // params.limitsLone, which the host compiles in
#endif

// A pixel as it was read; depth NaN: there is none.
typedef struct ReadPixel {
    vfloat3 irradiance, normal;
    vfloat depth, length;
} ReadPixel;

// Four pixels of a row, two on each side.
typedef struct RowTaps {
    vfloat3 irradiances[4], normals[4];
    vfloat depths[4];
} RowTaps;

// A pixel of a filtered row.
typedef struct RowPixel {
    FilterPoint point;
    vfloat3 irradiance;
} RowPixel;

#define INPUTS_IN SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth)
#define INPUTS_ARG SURFACE_ARG(inIrradiance), SURFACE_ARG(inNormalWs), SURFACE_ARG(inDepth)

// The four taps aside, as steps.
static int wayOf(int tap) { return tap < 2 ? tap - 2 : tap - 1; }
static float shareOf(const AtrousParams* params, int way) { return abs(way) == 1 ? params->share1 : params->share2; }

// The sum of the shares of those taps that lie in [0; size). Lanes lie at `first` and what follows; all at `first`, if count
// is 1. 0 if nobody asks.
static vfloat sharesInside(const AtrousParams* params, int first, int count, int size) {
    if (!LIMITS_LONE) return 0.0f;
    int step = params->stepPx;
    vfloat sum = 2.0f * (params->share1 + params->share2);
    if (first >= 2 * step && first + count + 2 * step <= size) return sum;
    vint place = first + (count > 1 ? laneIndex() : 0);
    sum = 0.0f;
    for (int tap = 0; tap < 4; ++tap) {
        vint at = place + wayOf(tap) * step;
        sum += vselect((at >= 0) & (at < size), shareOf(params, wayOf(tap)), 0.0f);
    }
    return sum;
}

static RowPixel unfiltered(const AtrousParams* params, Pixel px, ReadPixel read) {
    RowPixel r = {filterPoint(params, px, read.depth, read.normal, vrecip(max(read.length, 1.0f))), read.irradiance};
    return r;
}

static bool wantsTaps(const FilterPoint* p) { return anyLane((p->depth > 0.0f) & (p->fade > 0.0f)); }

// A row or a column through a pixel: its slope and offset, what they grow by from tap to tap, and sums over the taps.
typedef struct Line {
    vfloat slope, slopeStep, offset, offsetStep, sumWeights, luminances, count;
    vfloat3 sum;
} Line;

static Line lineThrough(const FilterPoint* p, f32x4 rayStep, f32x4 originStep) {
    vfloat zero = 0.0f;
    Line line = {p->slope, growth(p, rayStep), -p->depth * p->slope, growth(p, originStep), zero, zero, zero,
                 make3(zero, zero, zero)};
    return line;
}

static void addTap(Line* line, const AtrousParams* params, const FilterPoint* p, int way, vfloat depth, vfloat3 normal,
                   vfloat3 irradiance) {
    vfloat near = nearness(params, p, vmad(line->slopeStep, way, line->slope), vmad(line->offsetStep, way, line->offset),
                           1.0f / (float)(way * way), depth, normal);
    vfloat weight = shareOf(params, way) * near * near;
    line->sumWeights += weight;
    line->sum = mad3(weight, irradiance, line->sum);
}

// What a lone pixel's limit wants of a tap; if LIMITS_LONE, in a loop of its own: no branch parts the taps' arithmetic.
static void addLuminance(Line* line, vfloat depth, vfloat3 irradiance) {
    line->luminances += vselect(depth > 0.0f, luminance(irradiance), 0.0f);
    line->count += vselect(depth > 0.0f, 1.0f, 0.0f);
}

// The pixel and its taps. shares (sharesInside) and length: read only if LIMITS_LONE.
static vfloat3 meanOf(const Line* line, const AtrousParams* params, vfloat fade, vfloat3 irradiance, vfloat shares,
                      vfloat length) {
    if (LIMITS_LONE)
        irradiance = limitedAlone(irradiance, length, fade, line->sumWeights, shares, line->luminances, line->count);
    // fade lets the taps in; the pixel itself counts whole.
    vfloat3 sum = mad3(fade, line->sum, scale3(params->share0, irradiance));
    return scale3(vrecip(vmad(fade, line->sumWeights, params->share0)), sum);
}

static vfloat3 filterRow(const AtrousParams* params, Pixel px, int width, const RowPixel* row, vfloat length,
                         const RowTaps* taps) {
    Line line = lineThrough(&row->point, params->cameraRays.rayDx, params->cameraRays.originDx);
#pragma unroll
    for (int tap = 0; tap < 4; ++tap)
        addTap(&line, params, &row->point, wayOf(tap), taps->depths[tap], taps->normals[tap], taps->irradiances[tap]);
    if (LIMITS_LONE) {
#pragma unroll
        for (int tap = 0; tap < 4; ++tap) addLuminance(&line, taps->depths[tap], taps->irradiances[tap]);
    }
    vfloat shares = sharesInside(params, px.x, LANES, width);
    return meanOf(&line, params, row->point.fade, row->irradiance, shares, length);
}

// Of the third of five rows, a step apart. y of `height` is its row.
static vfloat3 filterColumn(const AtrousParams* params, const RowPixel* above2, const RowPixel* above,
                            const RowPixel* row, const RowPixel* below, const RowPixel* below2, int y, int height,
                            vfloat length) {
    const RowPixel* taps[4] = {above2, above, below, below2};
    vfloat3 mean = row->irradiance;
    if (wantsTaps(&row->point)) {
        Line line = lineThrough(&row->point, params->cameraRays.rayDy, params->cameraRays.originDy);
#pragma unroll
        for (int tap = 0; tap < 4; ++tap) {
            const RowPixel* q = taps[tap];
            addTap(&line, params, &row->point, wayOf(tap), q->point.depth, q->point.normal, q->irradiance);
        }
        if (LIMITS_LONE) {
#pragma unroll
            for (int tap = 0; tap < 4; ++tap) addLuminance(&line, taps[tap]->point.depth, taps[tap]->irradiance);
        }
        vfloat shares = sharesInside(params, y, 1, height);
        mean = meanOf(&line, params, row->point.fade, mean, shares, length);
    }
    return select3(row->point.depth > 0.0f, mean, make3(0.0f, 0.0f, 0.0f));
}

#if LANES == 1

// A pixel on its way: fetched, but not waited for.
typedef struct FetchedPixel {
    Stored3 irradiance, normal;
    vfloat depth, length;
    bool isThere;
} FetchedPixel;

static FetchedPixel fetchPixel(INPUTS_IN, SURFACE_IN(inLength), int x, int y) {
    Pixel px = {clamp(x, 0, inDepthLayout.widthPx - 1), clamp(y, 0, inDepthLayout.heightPx - 1)};
    FetchedPixel f = {fetch3(inIrradiance, px), fetch3(inNormalWs, px), load1(inDepth, px), load1(inLength, px),
                      px.x == x && px.y == y};
    return f;
}

static ReadPixel decodePixel(FetchedPixel f) {
    ReadPixel r = {decode3(f.irradiance), decode3(f.normal), f.isThere && f.depth > 0.0f ? f.depth : NAN, f.length};
    return r;
}

static void putTap(__local float4* irradiances, __local float4* normals, int at, ReadPixel read) {
    irradiances[at] = (float4)(read.irradiance.x, read.irradiance.y, read.irradiance.z, read.depth);
    normals[at] = (float4)(read.normal.x, read.normal.y, read.normal.z, 0.0f);
}

static RowTaps sharedTaps(__local const float4* irradiances, __local const float4* normals, int at, int step) {
    RowTaps taps;
#pragma unroll
    for (int tap = 0; tap < 4; ++tap) {
        float4 irradiance = irradiances[at + wayOf(tap) * step], normal = normals[at + wayOf(tap) * step];
        taps.irradiances[tap] = splat3(irradiance);
        taps.normals[tap] = splat3(normal);
        taps.depths[tap] = irradiance.w;
    }
    return taps;
}

// A group's columns. Pieces of a row in local memory, with what lies two steps to either side; rows in turn: one is written
// while one is read.
#define GROUP ATROUS_PAIR_GROUP(1)
static void walkColumns(INPUTS_IN, SURFACE_IN(inLength), SURFACE_OUT(outIrradiance), const AtrousParams* params, int top,
                        __local float4* irradiances, __local float4* normals) {
    int width = outIrradianceLayout.widthPx, height = outIrradianceLayout.heightPx, step = params->stepPx;
    int x = (int)get_global_id(0), y = top - 2 * step;
    // The first items bring what lies aside too.
    int i = (int)get_local_id(0), at = i + 2 * step, atAside = i < 2 * step ? i : GROUP + i;
    bool bringsAside = i < 4 * step;
    int aside = x - at + atAside;

    RowPixel row0, row1, row2, row3, row4;
    FetchedPixel own = fetchPixel(INPUTS_ARG, SURFACE_ARG(inLength), x, y), beside = own;
    if (bringsAside) beside = fetchPixel(INPUTS_ARG, SURFACE_ARG(inLength), aside, y);
    for (int row = -2; row < params->pairRows + 2; ++row, y += step) {
        __local float4* irradiancesHere = irradiances + (row & 1) * ATROUS_PAIR_PIECE_PX;
        __local float4* normalsHere = normals + (row & 1) * ATROUS_PAIR_PIECE_PX;
        FetchedPixel arrived = own, arrivedBeside = beside;
        own = fetchPixel(INPUTS_ARG, SURFACE_ARG(inLength), x, y + step);
        if (bringsAside) beside = fetchPixel(INPUTS_ARG, SURFACE_ARG(inLength), aside, y + step);

        ReadPixel read = decodePixel(arrived);
        putTap(irradiancesHere, normalsHere, at, read);
        if (bringsAside) putTap(irradiancesHere, normalsHere, atAside, decodePixel(arrivedBeside));
        barrier(CLK_LOCAL_MEM_FENCE);
        Pixel px = {x, y}, out = {x, y - 2 * step};
        row0 = row1;
        row1 = row2;
        row2 = row3;
        row3 = row4;
        row4 = unfiltered(params, px, read);
        if (wantsTaps(&row4.point)) {
            RowTaps taps = sharedTaps(irradiancesHere, normalsHere, at, step);
            row4.irradiance = filterRow(params, px, width, &row4, read.length, &taps);
        }
        if (row < 2 || x >= width || out.y >= height) continue;
        vfloat length = 0.0f;
        if (LIMITS_LONE) length = load1(inLength, out);
        store3(outIrradiance, out, filterColumn(params, &row0, &row1, &row2, &row3, &row4, out.y, height, length));
    }
}

#else

static ReadPixel readPixel(INPUTS_IN, SURFACE_IN(inLength), Pixel px) {
    const vfloat3 zero3 = make3(0.0f, 0.0f, 0.0f);
    ReadPixel r = {zero3, zero3, (vfloat)(NAN), (vfloat)(0.0f)};
    if (px.y < 0 || px.y >= inDepthLayout.heightPx) return r;
    vfloat depth = load1(inDepth, px);
    r.depth = vselect(depth > 0.0f, depth, NAN);
    r.normal = load3(inNormalWs, px);
    r.irradiance = load3(inIrradiance, px);
    r.length = load1(inLength, px);
    return r;
}

// All taps at once: what is close in the source is under way together.
static RowTaps readTaps(INPUTS_IN, Pixel px, int step) {
    int width = inDepthLayout.widthPx;
    bool isInner = px.x >= 2 * step && px.x + LANES + 2 * step <= width;
    RowTaps taps;
#pragma unroll
    for (int tap = 0; tap < 4; ++tap) {
        int x = px.x + wayOf(tap) * step;
        vfloat depth = loadFrom1(inDepth, x, px.y);
        taps.normals[tap] = loadFrom3(inNormalWs, x, px.y);
        taps.irradiances[tap] = loadFrom3(inIrradiance, x, px.y);
        vmask isThere = depth > 0.0f;
        if (!isInner) isThere &= (x + laneIndex() >= 0) & (x + laneIndex() < width);
        taps.depths[tap] = vselect(isThere, depth, NAN);
    }
    return taps;
}

// An item's strip.
static void walkStrip(INPUTS_IN, SURFACE_IN(inLength), SURFACE_OUT(outIrradiance), const AtrousParams* params, int top) {
    int width = outIrradianceLayout.widthPx, height = outIrradianceLayout.heightPx, step = params->stepPx;
    int left = (int)get_global_id(0) * (ATROUS_PAIR_STRIP(LANES) * LANES);
    if (left >= width) return;
    RowPixel rows[5][ATROUS_PAIR_STRIP(LANES)];  // row r is in r % 5
    for (int row = 0; row < params->pairRows + 4; ++row) {
        Pixel px = {left, top + (row - 2) * step};
        if (px.y - 2 * step >= height) return;
        for (int k = 0; k < ATROUS_PAIR_STRIP(LANES) && px.x < width; ++k, px.x += LANES) {
            ReadPixel read = readPixel(INPUTS_ARG, SURFACE_ARG(inLength), px);
            RowPixel* to = &rows[row % 5][k];
            *to = unfiltered(params, px, read);
            if (!wantsTaps(&to->point)) continue;
            RowTaps taps = readTaps(INPUTS_ARG, px, step);
            to->irradiance = filterRow(params, px, width, to, read.length, &taps);
        }
        if (row < 4) continue;
        px.x = left;
        px.y -= 2 * step;
        for (int k = 0; k < ATROUS_PAIR_STRIP(LANES) && px.x < width; ++k, px.x += LANES) {
            vfloat length = 0.0f;
            if (LIMITS_LONE) length = load1(inLength, px);
            store3(outIrradiance, px,
                   filterColumn(params, &rows[(row + 1) % 5][k], &rows[(row + 2) % 5][k], &rows[(row + 3) % 5][k],
                                &rows[(row + 4) % 5][k], &rows[row % 5][k], px.y, height, length));
        }
    }
}
#endif

__attribute__((reqd_work_group_size(ATROUS_PAIR_GROUP(LANES), 1, 1)))
__kernel void atrous_pair(SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(inLength),
                          SURFACE_OUT(outIrradiance), const AtrousParams params) {
    int item = (int)get_global_id(1), step = params.stepPx;
    int top = item / step * step * params.pairRows + item % step;
    if (top >= outIrradianceLayout.heightPx) return;
#if LANES == 1
    __local float4 irradiances[2 * ATROUS_PAIR_PIECE_PX], normals[2 * ATROUS_PAIR_PIECE_PX];
    walkColumns(INPUTS_ARG, SURFACE_ARG(inLength), SURFACE_ARG(outIrradiance), &params, top, irradiances, normals);
#else
    walkStrip(INPUTS_ARG, SURFACE_ARG(inLength), SURFACE_ARG(outIrradiance), &params, top);
#endif
}
