// history_check: does what is remembered still fit what arrives? Two sums a tile, for history_confidence to judge.
//   d = luminance(in) - luminance(accumulated) a pixel
//   in   inIrradiance    lx: this frame's estimate, 0 on sky
//   in   inAccumulated   lx: temporal's output of this frame
//   out  outSums         (sum d, sum d^2): one float2 a tile of CONFIDENCE_TILE_PX pixels a side, rows of tiles
//   Work 2D, one item per tile, any local size; items past the edge return.

#include "history_check_params.h"
#include "surface.clh"

__kernel void history_check(SURFACE_IN(inIrradiance), SURFACE_IN(inAccumulated), __global float2* restrict outSums) {
    int columns = (inIrradianceLayout.widthPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX;
    int i = (int)get_global_id(0), j = (int)get_global_id(1);
    if (i >= columns || j * CONFIDENCE_TILE_PX >= inIrradianceLayout.heightPx) return;
    int bottom = min((j + 1) * CONFIDENCE_TILE_PX, inIrradianceLayout.heightPx);
    vfloat sum = 0.0f, squares = 0.0f;
    Pixel px;
    for (px.y = j * CONFIDENCE_TILE_PX; px.y < bottom; ++px.y) {
        for (px.x = i * CONFIDENCE_TILE_PX; px.x < (i + 1) * CONFIDENCE_TILE_PX; px.x += LANES) {
            if (px.x >= inIrradianceLayout.widthPx) break;
            vfloat d = min(luminance(load3(inIrradiance, px)), 1e15f) - luminance(load3(inAccumulated, px));
            d = vselect(px.x + laneIndex() < inIrradianceLayout.widthPx, d, 0.0f);
            sum += d;
            squares = vmad(d, d, squares);
        }
    }
    outSums[j * columns + i] = (float2)(sumLanes(sum), sumLanes(squares));
}
