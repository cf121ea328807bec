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

__kernel void history_confidence(__global const float2* restrict inSums, __global float* restrict outConfidence,
                                 const HistoryCheckParams params) {
    int i = (int)get_global_id(0), j = (int)get_global_id(1);
    if (i >= params.columns || j * CONFIDENCE_TILE_PX >= params.heightPx) return;
    float2 own = (float2)(0.0f, 0.0f), around = own;
    int top = j * CONFIDENCE_TILE_PX, bottom = top + CONFIDENCE_TILE_PX;
    int first = max(top - CONFIDENCE_TILE_PX, 0), last = min(bottom + CONFIDENCE_TILE_PX, params.heightPx) - 1;
    for (int y = first; y <= last; ++y) {
        for (int x = max(i - 1, 0); x <= min(i + 1, params.columns - 1); ++x) {
            float2 sums = inSums[y * params.columns + x];
            around += sums;
            if (x == i && y >= top && y < bottom) own += sums;
        }
    }
    outConfidence[j * params.columns + i] = min(confidenceOf(own, &params), confidenceOf(around, &params));
}
