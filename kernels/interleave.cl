// interleave: a surface back into plain pixels, for whoever reads it on the host.
//   in   inColor    three numbers a pixel
//   in   inDepth    m, > 0; 0 on sky
//   out  outPixels  RGBA32F, rows top to bottom without padding; w = 1, or 0 on sky
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "surface.clh"

__kernel void interleave(SURFACE_IN(inColor), SURFACE_IN(inDepth), __global float4* restrict outPixels) {
    Pixel px = itemPixel();
    if (isOutside(px, inColorLayout)) return;
    vfloat3 color = load3(inColor, px);
    VfloatLanes r, g, b, w;
    r.v = color.x;
    g.v = color.y;
    b.v = color.z;
    w.v = vselect(load1(inDepth, px) > 0.0f, 1.0f, 0.0f);
    for (int i = 0; i < min(LANES, inColorLayout.widthPx - px.x); ++i)
        outPixels[px.y * inColorLayout.widthPx + px.x + i] = (float4)(r.lane[i], g.lane[i], b.lane[i], w.lane[i]);
}
