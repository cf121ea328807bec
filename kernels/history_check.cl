// history_check: does what is remembered still fit what arrives? Two sums, for history_confidence to judge a tile by.
//   in   inChange       d, lx: temporal's, 0 on sky
//   out  outSums         (sum d, sum d^2) of a tile's pixels of one row: CONFIDENCE_TILE_PX; a row of tiles a row of pixels
//   Work 2D, one item per row of a tile, any local size; items past the edge return. (An item a tile would be too few for
//   a GPU: 2.5 times as long on an H100.)

#include "history_check_params.h"
#include "surface.clh"

__kernel void history_check(SURFACE_IN(inChange), __global float2* restrict outSums) {
    int columns = (inChangeLayout.widthPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX;
    int i = (int)get_global_id(0);
    Pixel px = {i * CONFIDENCE_TILE_PX, (int)get_global_id(1)};
    if (isOutside(px, inChangeLayout)) return;
    vfloat sum = 0.0f, squares = 0.0f;
    for (; px.x < min((i + 1) * CONFIDENCE_TILE_PX, inChangeLayout.widthPx); px.x += LANES) {
        vfloat d = vselect(px.x + laneIndex() < inChangeLayout.widthPx, load1(inChange, px), 0.0f);
        sum += d;
        squares = vmad(d, d, squares);
    }
    outSums[px.y * columns + i] = (float2)(sumLanes(sum), sumLanes(squares));
}
