// surface_flip: gather of one and of three numbers a pixel, from the pixel opposite.
//   in   inOne, inThree    surfaces of one extent
//   out  outOne, outThree  the same, turned by 180 degrees
//   Work 2D, one item per LANES pixels of a row.

#include "surface.clh"

__kernel void surface_flip(SURFACE_IN(inOne), SURFACE_IN(inThree), SURFACE_OUT(outOne), SURFACE_OUT(outThree)) {
    Pixel px = itemPixel();
    if (isOutside(px, outOneLayout)) return;
    vint x = max(outOneLayout.widthPx - 1 - (px.x + laneIndex()), 0);
    vint y = (vint)(outOneLayout.heightPx - 1 - px.y);
    store1(outOne, px, gather1(inOne, x, y));
    store3(outThree, px, gather3(inThree, x, y));
}
