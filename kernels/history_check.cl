// history_check: does what is remembered still fit what arrives? One answer a tile, for the next frame's temporal.
//   d = luminance(in) - luminance(accumulated) a pixel,   R = (sum d)^2 / sum d^2 over the tile
//   Noise has no sign: R is about 1, whatever its size, fireflies or not (d's own spread is the yardstick). A light that
//   changed pulls all pixels one way: R tends to their number. So no threshold depends on the scene.
//   confidence = 1 up to keptBelow, 0 from droppedAbove on, linear between
//   in   inIrradiance           lx: this frame's estimate, 0 on sky
//   in   inAccumulated          lx: temporal's output of this frame
//   out  outConfidence          one float a tile of CONFIDENCE_TILE_PX pixels a side, rows of tiles
//   Work 2D, one item per tile, any local size; items past the edge return.

#include "history_check_params.h"
#include "surface.clh"

__kernel void history_check(SURFACE_IN(inIrradiance), SURFACE_IN(inAccumulated), __global float* restrict outConfidence,
                            const HistoryCheckParams params) {
    int columns = (inIrradianceLayout.widthPx + CONFIDENCE_TILE_PX - 1) / CONFIDENCE_TILE_PX;
    int i = (int)get_global_id(0), j = (int)get_global_id(1);
    if (i >= columns || j * CONFIDENCE_TILE_PX >= inIrradianceLayout.heightPx) return;
    int bottom = min((j + 1) * CONFIDENCE_TILE_PX, inIrradianceLayout.heightPx);
    vfloat sum = 0.0f, squares = 0.0f;
    Pixel px;
    for (px.y = j * CONFIDENCE_TILE_PX; px.y < bottom; ++px.y) {
        for (px.x = i * CONFIDENCE_TILE_PX; px.x < (i + 1) * CONFIDENCE_TILE_PX; px.x += LANES) {
            if (px.x >= inIrradianceLayout.widthPx) break;
            vfloat d = luminance(load3(inIrradiance, px)) - luminance(load3(inAccumulated, px));
            d = vselect(px.x + laneIndex() < inIrradianceLayout.widthPx, d, 0.0f);
            sum += d;
            squares = vmad(d, d, squares);
        }
    }
    float total = sumLanes(sum), spread = sumLanes(squares);
    float ratio = spread > 0.0f ? total * total / spread : 0.0f;
    outConfidence[j * columns + i] =
        clamp((params.droppedAbove - ratio) / (params.droppedAbove - params.keptBelow), 0.0f, 1.0f);
}
