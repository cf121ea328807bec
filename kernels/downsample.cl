// downsample: a G-buffer of lower resolution from picked pixels (pick_grid.h says which, and why picked).
//   in   inNormalWs   unit
//   in   inDepth      m; 0 on sky
//   in   inMotion     xy: pixels to the same point in the previous frame; z: m; read only if picksMotion
//   out  outNormalWs, outDepth   the picked pixels' own
//   out  outMotion    xy in texels of the lower resolution; z as it was; written only if picksMotion
//   Work 2D, one item per LANES texels of a row, any local size; items past the edge return.

#include "downsample_params.h"
#include "surface.clh"

__kernel void downsample(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(inMotion), SURFACE_OUT(outNormalWs),
                         SURFACE_OUT(outDepth), SURFACE_OUT(outMotion), const DownsampleParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outDepthLayout)) return;
    vint x = ((px.x + laneIndex()) << params.grid.strideLog2) + params.grid.offsetXPx;
    x = min(x, inDepthLayout.widthPx - 1);  // lanes past the edge
    vint y = (vint)((px.y << params.grid.strideLog2) + params.grid.offsetYPx);
    store3(outNormalWs, px, gather3(inNormalWs, x, y));
    store1(outDepth, px, gather1(inDepth, x, y));
    if (params.picksMotion) {
        vfloat3 motion = gather3(inMotion, x, y);
        vfloat perPixel = 1.0f / (float)(1 << params.grid.strideLog2);
        store3(outMotion, px, make3(motion.x * perPixel, motion.y * perPixel, motion.z));
    }
}
