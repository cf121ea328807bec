// history_check: does what is remembered still fit what arrives? Two sums, for history_confidence to judge a tile by.
//   in   inChange   d, lx: temporal's, 0 on sky
//   out  outSums    (sum d, sum d^2) a tile: CONFIDENCE_TILE_PX
//   Work 2D, one item per LANES columns of a tile, of which a group adds up those of its tiles; items past the edge add
//   nothing. (An item a tile would be too few for a GPU.)

#include "history_check_params.h"
#include "surface.clh"

#define GROUP 32  // as many items as any device takes; on CPUs, of several lanes, faster than more
#define ITEMS (CONFIDENCE_TILE_PX / LANES)  // a tile

__attribute__((reqd_work_group_size(GROUP, 1, 1)))
__kernel void history_check(SURFACE_IN(inChange), __global float2* restrict outSums) {
    __local float2 parts[GROUP];
    int columns = (inChangeLayout.widthPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX;
    int item = (int)get_local_id(0), tileX = (int)get_global_id(0) / ITEMS, tileY = (int)get_global_id(1);
    int x = min((int)get_global_id(0) * LANES, columns * CONFIDENCE_TILE_PX - LANES);
    vmask isInside = x + laneIndex() < inChangeLayout.widthPx;
    vfloat sum = 0.0f, squares = 0.0f;
#pragma unroll
    for (int row = 0; row < CONFIDENCE_TILE_PX; ++row) {  // loads that wait for nothing: all under way together
        int y = tileY * CONFIDENCE_TILE_PX + row;
        vfloat d = loadFrom1(inChange, x, min(y, inChangeLayout.heightPx - 1));
        d = vselect(isInside & (y < inChangeLayout.heightPx ? -1 : 0), d, 0.0f);
        sum += d;
        squares = vmad(d, d, squares);
    }
    parts[item] = (float2)(sumLanes(sum), sumLanes(squares));
    barrier(CLK_LOCAL_MEM_FENCE);
    if (tileX >= columns || item % ITEMS > 0) return;
    float2 sums = (float2)(0.0f, 0.0f);
    for (int k = 0; k < ITEMS; ++k) sums += parts[item + k];
    outSums[tileY * columns + tileX] = sums;
}
