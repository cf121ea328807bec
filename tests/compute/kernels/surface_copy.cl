// surface_copy: load and store of one and of three numbers a pixel.
//   in   inOne, inThree    surfaces of one extent
//   out  outOne, outThree  the same
//   Work 2D, one item per LANES pixels of a row.

#include "surface.clh"

__kernel void surface_copy(SURFACE_IN(inOne), SURFACE_IN(inThree), SURFACE_OUT(outOne), SURFACE_OUT(outThree)) {
    Pixel px = itemPixel();
    if (isOutside(px, outOneLayout)) return;
    store1(outOne, px, load1(inOne, px));
    store3(outThree, px, load3(inThree, px));
}
