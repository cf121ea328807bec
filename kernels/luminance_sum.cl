// luminance_sum: the logarithms of the picture's luminance, summed over cells of a fixed grid.
//   A cell's sum is (sum of log2 L, number of pixels) over its pixels that are not sky and not black; exposure.cl adds the
//   cells in a fixed order, so a picture has one exposure on a device, whatever the number of its cores.
//   in   inRadiance  cd/m^2
//   in   inDepth     m; 0 on sky
//   out  outCells    LUMINANCE_CELLS_X x LUMINANCE_CELLS_Y float2
//   Work 2D, one item a cell, any local size; items past the grid return.

#include "exposure_params.h"
#include "math.clh"
#include "surface.clh"

__kernel void luminance_sum(SURFACE_IN(inRadiance), SURFACE_IN(inDepth), __global float2* restrict outCells) {
    int cellX = get_global_id(0), cellY = get_global_id(1);
    if (cellX >= LUMINANCE_CELLS_X || cellY >= LUMINANCE_CELLS_Y) return;
    // Columns in steps of 16, so that cells are the same at every width.
    int blocks = (inRadianceLayout.widthPx + 15) / 16;
    int xBegin = cellX * blocks / LUMINANCE_CELLS_X * 16;
    int xEnd = min((cellX + 1) * blocks / LUMINANCE_CELLS_X * 16, inRadianceLayout.widthPx);
    int yBegin = cellY * inRadianceLayout.heightPx / LUMINANCE_CELLS_Y;
    int yEnd = (cellY + 1) * inRadianceLayout.heightPx / LUMINANCE_CELLS_Y;

    vfloat sum = 0.0f, count = 0.0f;
    for (int y = yBegin; y < yEnd; ++y) {
        for (int x = xBegin; x < xEnd; x += LANES) {
            Pixel px = {x, y};
            vfloat l = luminance(load3(inRadiance, px));
            vmask counts = (l > 1e-12f) & (load1(inDepth, px) > 0.0f) & (x + laneIndex() < xEnd);
            sum += vselect(counts, es_log2(max(l, 1e-12f)), 0.0f);
            count += vselect(counts, 1.0f, 0.0f);
        }
    }
    outCells[cellY * LUMINANCE_CELLS_X + cellX] = (float2)(sumLanes(sum), sumLanes(count));
}
