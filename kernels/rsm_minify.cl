// rsm_minify: in place of rsm_pack, one record for each block of `minify` x `minify` texels, so that few samples find all
// of the light.
//   flux      the block's sum, channel by channel: what the map sends out stays the same to rounding, every frame
//   position  and normal: of one texel of the block, picked with a probability of flux (R + G + B) over the block's sum
//   radius    of the disc whose area is that of all lit texels of the block
//   A mean of positions or normals would lie on no surface, and its cosines lose energy wherever a block is not flat. A
//   texel picked by its flux w_i stands for the block: the expected value of W G_i is sum w_i G_i, W = sum w_i. Without bias
//   but for the disc, which is the block's and not the texel's: what is nearer than its radius gets less light.
//   For each channel that holds where a block is of one colour; else its colours mix, within the block. The other choice,
//   the picked texel's colour times W / w_i, has no bias at all but conserves no channel and adds noise of colour.
//   Blocks over the map's right and lower border are of the texels that are there.
//   in   inDepth     m along the light's -z, > 0; 0 where the light meets nothing
//   in   inNormalWs  unit
//   in   inFlux      lm, >= 0
//   in   lights      LightParams, one a map
//   out  outRecords  RsmRecord, rows of ceil(sizePx / minify); flux 0 where the light meets nothing
//   Work 2D, one item per LANES blocks of a row, over all maps below one another; items past the edge return.

#include "mixed.clh"
#include "rsm.clh"
#include "rsm_record.clh"

// The same texel is picked on every device.
#pragma OPENCL FP_CONTRACT OFF

// [0; 1) for each block and seed.
static vfloat blockRandom(vint block, uint seed) { return fractionOf(mixed(asVuint(block) + mixed((vuint)(seed)))); }

__kernel void rsm_minify(SURFACE_IN(inDepth), SURFACE_IN(inNormalWs), SURFACE_IN(inFlux),
                         __global const LightParams* restrict lights, __global RsmRecord* restrict outRecords,
                         const RsmPackParams params) {
    Pixel px = itemPixel();
    int blocks = (params.sizePx + params.minify - 1) / params.minify;  // a side
    if (px.x >= blocks || px.y >= blocks * params.lightCount) return;
    const LightParams light = lights[px.y / blocks];
    int firstRow = px.y % blocks * params.minify;
    int map = px.y / blocks;
    int mapRow = map * params.sizePx;
    int rows = min(params.minify, params.sizePx - firstRow);
    vint firstColumn = (px.x + laneIndex()) * params.minify;

    vfloat3 flux = make3(0.0f, 0.0f, 0.0f);
    vfloat total = 0.0f, area = 0.0f;
    for (int i = 0; i < rows * params.minify; ++i) {
        vint x = firstColumn + i % params.minify;
        int y = firstRow + i / params.minify;
        vint xInside = min(x, (vint)(params.sizePx - 1));
        vfloat depth = gather1(inDepth, xInside, (vint)(mapRow + y));
        vfloat3 normalWs = gather3(inNormalWs, xInside, (vint)(mapRow + y));
        vfloat3 f = gather3(inFlux, xInside, (vint)(mapRow + y));
        vmask isHit = (x < params.sizePx) & (depth > 0.0f);
        f = select3(isHit, make3(max(f.x, 0.0f), max(f.y, 0.0f), max(f.z, 0.0f)), splat3((float4)(0.0f)));
        vfloat weight = f.x + f.y + f.z;
        vfloat3 positionWs = positionFromDepth(&light.rsmRays, x, (vint)(y), depth);
        vfloat radius = min(texelRadius(&light, positionWs, normalWs, depth), 60000.0f);
        flux = add3(flux, f);
        total += weight;
        area += vselect(weight > 0.0f, radius * radius, 0.0f);
    }

    // The last lit texel with less than a random part of the flux before it.
    vfloat threshold = blockRandom(px.y * blocks + px.x + laneIndex(), params.seed) * total;
    vfloat before = 0.0f, pickedDepth = 0.0f;
    vint pickedX = min(firstColumn, (vint)(params.sizePx - 1));
    vint pickedY = (vint)(firstRow);
    for (int i = 0; i < rows * params.minify; ++i) {
        vint x = firstColumn + i % params.minify;
        int y = firstRow + i / params.minify;
        vint xInside = min(x, (vint)(params.sizePx - 1));
        vfloat depth = gather1(inDepth, xInside, (vint)(mapRow + y));
        vfloat3 f = gather3(inFlux, xInside, (vint)(mapRow + y));
        vmask isHit = (x < params.sizePx) & (depth > 0.0f);
        vfloat weight = vselect(isHit, max(f.x, 0.0f) + max(f.y, 0.0f) + max(f.z, 0.0f), 0.0f);
        vmask isPicked = (weight > 0.0f) & (before <= threshold);
        pickedX = vselectInt(isPicked, x, pickedX);
        pickedY = vselectInt(isPicked, (vint)(y), pickedY);
        pickedDepth = vselect(isPicked, depth, pickedDepth);
        before += weight;
    }
    storeRecords(outRecords + px.y * blocks + px.x, blocks - px.x,
                 positionFromDepth(&light.rsmRays, pickedX, pickedY, pickedDepth),
                 gather3(inNormalWs, pickedX, pickedY + mapRow), flux, min(sqrt(area), 60000.0f));
}
