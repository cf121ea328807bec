// tile_average: the mean over a tile of the turned pattern (rsm_gather.cl), as far as it lies on one surface.
//   out(p) = mean of in(q) over those q of [x - 1; x + 2] x [y - 1; y + 2] that lie on p's surface
//   Any 4 x 4 pixels hold each of the tile's 16 turns once: where all of them count, the mean is that of one pattern
//   with 16 times as many samples, and nothing of the tile is left to see. Its middle lies half a pixel aside.
//   q lies on p's surface if n_p.n_q >= minNormalCosine and its point is at most planeTolerance times the way to q off
//   p's plane; the way is across the view, at p's depth, so that the scene's scale does not matter. p itself always counts.
//   Interleaved sampling: Keller & Heidrich 2001.
//   in   inIrradiance   lx
//   in   inNormalWs, inDepth   unit; m, 0 on sky
//   out  outIrradiance  lx, finite, between the least and the largest of those that count; 0 on sky
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "geometry.clh"
#include "surface.clh"
#include "tile_average_params.h"

// What a pixel counts: a power of two, so that it costs no digit, and the largest float 16 times is still a float.
#define ONE 0.0625f

__kernel void tile_average(SURFACE_IN(inIrradiance), SURFACE_IN(inNormalWs), SURFACE_IN(inDepth),
                           SURFACE_OUT(outIrradiance), const TileAverageParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outIrradianceLayout)) return;
    int width = outIrradianceLayout.widthPx, height = outIrradianceLayout.heightPx;
    vfloat depth = load1(inDepth, px);
    vmask isSurface = depth > 0.0f;
    if (!anyLane(isSurface)) {
        store3(outIrradiance, px, make3(0.0f, 0.0f, 0.0f));
        return;
    }
    vfloat3 normalWs = load3(inNormalWs, px);
    vfloat reach = params.planeTolerance * vmad(depth, params.footprintPerM, params.footprintM);

    // q's distance from p's plane is n.(x_q - x_p); with x = origin + depth ray, both linear in the pixel, it comes
    // down to these dot products.
    const ViewRays* rays = &params.cameraRays;
    vfloat originX = dot3(normalWs, splat3(rays->originDx)), originY = dot3(normalWs, splat3(rays->originDy));
    vfloat rayX = dot3(normalWs, splat3(rays->rayDx)), rayY = dot3(normalWs, splat3(rays->rayDy));
    vfloat3 ray = mad3(toVfloat(px.x + laneIndex()), splat3(rays->rayDx),
                       mad3((vfloat)((float)px.y), splat3(rays->rayDy), splat3(rays->ray)));
    vfloat along = dot3(normalWs, ray);

    vfloat count = ONE;
    vfloat3 sum = scale3(ONE, load3(inIrradiance, px));
    for (int dy = -1; dy <= 2; ++dy) {
        int y = px.y + dy;
        if (y < 0 || y >= height) continue;
        for (int dx = -1; dx <= 2; ++dx) {
            int x = px.x + dx;
            if (dx == 0 && dy == 0) continue;
            vfloat tapDepth = loadFrom1(inDepth, x, y);
            vfloat plane = vmad(tapDepth, vmad((float)dx, rayX, vmad((float)dy, rayY, along)), -depth * along);
            plane = vmad((float)dx, originX, vmad((float)dy, originY, plane));
            vmask counts = (x + laneIndex() >= 0) & (x + laneIndex() < width) & (tapDepth > 0.0f);
            counts &= fabs(plane) <= reach * sqrt((float)(dx * dx + dy * dy));
            counts &= dot3(normalWs, loadFrom3(inNormalWs, x, y)) >= params.minNormalCosine;
            vfloat weight = vselect(counts, ONE, 0.0f);
            count += weight;
            sum = mad3(weight, loadFrom3(inIrradiance, x, y), sum);
        }
    }
    store3(outIrradiance, px, select3(isSurface, scale3(1.0f / count, sum), make3(0.0f, 0.0f, 0.0f)));
}
