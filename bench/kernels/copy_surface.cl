// copy_surface: what a device reads and writes at best by a kernel of this dialect: three numbers a pixel, and nothing
// done to them.
//   in   inSurface, out outSurface   three numbers a pixel
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "surface.clh"

__kernel void copy_surface(SURFACE_IN(inSurface), SURFACE_OUT(outSurface)) {
    Pixel px = itemPixel();
    if (isOutside(px, outSurfaceLayout)) return;
    store3(outSurface, px, load3(inSurface, px));
}
