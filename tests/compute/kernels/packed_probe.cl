// packed_probe: three numbers a pixel into a surface, as kernels of the library store them.
//   in   inNumbers  three floats a pixel, rows without padding
//   out  outThree   a surface
//   Work 2D, one item per LANES pixels of a row.

#include "surface.clh"

__kernel void packed_probe(__global const float* restrict inNumbers, SURFACE_OUT(outThree)) {
    Pixel px = itemPixel();
    if (isOutside(px, outThreeLayout)) return;
    vint at = 3 * (px.y * outThreeLayout.widthPx + clampInt(px.x + laneIndex(), 0, outThreeLayout.widthPx - 1));
    store3(outThree, px, make3(gatherFloats(inNumbers, at), gatherFloats(inNumbers, at + 1), gatherFloats(inNumbers, at + 2)));
}
