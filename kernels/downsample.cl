// downsample: a G-buffer of lower resolution from picked pixels (pick_grid.h says which, and why picked).
//   in   inNormalWs   unit
//   in   inDepth      m; 0 on sky
//   in   inMotion     xy: pixels to the same point in the previous frame; z: m; read only if picksMotion
//   out  outNormalWs, outDepth   the picked pixels' own
//   out  outMotion    xy in texels of the lower resolution; z as it was; written only if picksMotion
//   Work 2D, one item per LANES texels of a row, any local size; items past the edge return.

#include "downsample_params.h"
#include "pick_grid.clh"

__kernel void downsample(SURFACE_IN(inNormalWs), SURFACE_IN(inDepth), SURFACE_IN(inMotion), SURFACE_OUT(outNormalWs),
                         SURFACE_OUT(outDepth), SURFACE_OUT(outMotion), const DownsampleParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outDepthLayout)) return;
    const PickGrid grid = params.grid;
    int x = (px.x << grid.strideLog2) + grid.offsetXPx, y = (px.y << grid.strideLog2) + grid.offsetYPx;
    store3(outNormalWs, px, pickRow3(SURFACE_ARG(inNormalWs), grid.strideLog2, x, y));
    store1(outDepth, px, pickRow1(SURFACE_ARG(inDepth), grid.strideLog2, x, y));
    if (params.picksMotion) {
        vfloat3 motion = pickRow3(SURFACE_ARG(inMotion), grid.strideLog2, x, y);
        vfloat perPixel = 1.0f / (float)(1 << grid.strideLog2);
        store3(outMotion, px, make3(motion.x * perPixel, motion.y * perPixel, motion.z));
    }
}
