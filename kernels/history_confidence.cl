// history_confidence: how far history is to be believed, a tile.
//   R = (sum d)^2 / sum d^2 over pixels, with d what arrives less what is remembered (temporal.cl)
//   Noise has no sign: R is about 1, whatever its size (d's own spread is the yardstick). A light that changed pulls all
//   pixels one way: R tends to their number. So no threshold depends on the scene. A pixel that outshines all others
//   makes R 1 too, and hides a change around it until it has faded: fireflyFactor is against that.
//   confidence = 1 up to keptBelow, 0 from droppedAbove on, linear between; the lesser of the tile's own and that of the
//   3 x 3 tiles around it, whose nine times as many pixels tell a third of the change from noise.
//   in   inSums          (sum d, sum d^2) of each row of a tile
//   out  outConfidence   one float a tile
//   Work 2D, one item per tile, any local size; items past the edge return.

#include "history_check_params.h"

static float confidenceOf(float2 sums, const HistoryCheckParams* params) {
    float ratio = sums.y > 0.0f ? sums.x * sums.x / sums.y : 0.0f;
    return clamp((params->droppedAbove - ratio) / (params->droppedAbove - params->keptBelow), 0.0f, 1.0f);
}

// The sums of a tile's rows: loads that wait for nothing, all under way together.
static float2 tileSums(__global const float2* restrict rows, const HistoryCheckParams* params, int i, int j) {
    float2 sums = (float2)(0.0f, 0.0f);
    if (i < 0 || i >= params->columns) return sums;
#pragma unroll
    for (int row = 0; row < CONFIDENCE_TILE_PX; ++row) {
        int y = j * CONFIDENCE_TILE_PX + row;
        float2 own = rows[clamp(y, 0, params->heightPx - 1) * params->columns + i];
        if (y >= 0 && y < params->heightPx) sums += own;
    }
    return sums;
}

__kernel void history_confidence(__global const float2* restrict inSums, __global float* restrict outConfidence,
                                 const HistoryCheckParams params) {
    int i = (int)get_global_id(0), j = (int)get_global_id(1);
    if (i >= params.columns || j * CONFIDENCE_TILE_PX >= params.heightPx) return;
    float2 own = tileSums(inSums, &params, i, j), around = own;
    for (int tile = 0; tile < 9; ++tile)
        if (tile != 4) around += tileSums(inSums, &params, i + tile % 3 - 1, j + tile / 3 - 1);
    outConfidence[j * params.columns + i] = min(confidenceOf(own, &params), confidenceOf(around, &params));
}
