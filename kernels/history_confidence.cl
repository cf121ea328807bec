// history_confidence: how far history is to be believed, a tile.
//   R = (sum d)^2 / sum d^2 over pixels, with d what arrives less what is remembered (temporal.cl)
//   Noise has no sign: R is about 1, whatever its size (d's own spread is the yardstick). A light that changed pulls all
//   pixels one way: R tends to their number. So no threshold depends on the scene. A pixel that outshines all others
//   makes R 1 too, and hides a change around it until it has faded: fireflyFactor is against that.
//   confidence = 1 up to keptBelow, 0 from droppedAbove on, linear between; the lesser of the tile's own and that of the
//   3 x 3 tiles around it, whose nine times as many pixels tell a third of the change from noise.
//   in   inSums          (sum d, sum d^2) a tile
//   out  outConfidence   one float a tile
//   Work 2D, one item per tile, any local size; items past the edge return.

#include "history_check_params.h"

static float confidenceOf(float2 sums, const HistoryCheckParams* params) {
    float ratio = sums.y > 0.0f ? sums.x * sums.x / sums.y : 0.0f;
    return clamp((params->droppedAbove - ratio) / (params->droppedAbove - params->keptBelow), 0.0f, 1.0f);
}

__kernel void history_confidence(__global const float2* restrict inSums, __global float* restrict outConfidence,
                                 const HistoryCheckParams params) {
    int i = (int)get_global_id(0), j = (int)get_global_id(1);
    if (i >= params.columns || j >= params.rows) return;
    float2 around = (float2)(0.0f, 0.0f);
#pragma unroll
    for (int tile = 0; tile < 9; ++tile) {
        int x = i + tile % 3 - 1, y = j + tile / 3 - 1;
        float2 sums = inSums[clamp(y, 0, params.rows - 1) * params.columns + clamp(x, 0, params.columns - 1)];
        if (x >= 0 && x < params.columns && y >= 0 && y < params.rows) around += sums;
    }
    float2 own = inSums[j * params.columns + i];
    outConfidence[j * params.columns + i] = min(confidenceOf(own, &params), confidenceOf(around, &params));
}
