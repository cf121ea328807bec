// surface_shift: a row read from a pixel beside it, 0 where that is outside.
//   in   inOne, inThree    surfaces of one extent
//   out  outOne, outThree  the same, moved left by shiftPx
//   Work 2D, one item per LANES pixels of a row.

#include "surface.clh"

__kernel void surface_shift(SURFACE_IN(inOne), SURFACE_IN(inThree), SURFACE_OUT(outOne), SURFACE_OUT(outThree),
                            const int shiftPx) {
    Pixel px = itemPixel();
    if (isOutside(px, outOneLayout)) return;
    int x = px.x + shiftPx;
    vmask isOnRow = (x + laneIndex() >= 0) & (x + laneIndex() < inOneLayout.widthPx);
    store1(outOne, px, vselect(isOnRow, loadFrom1(inOne, x, px.y), 0.0f));
    store3(outThree, px, select3(isOnRow, loadFrom3(inThree, x, px.y), make3(0.0f, 0.0f, 0.0f)));
}
