// record_probe: packed RSM texels, gathered one a lane and broadcast.
//   in   rsm         RsmRecord, rows of sizePx
//   in   inX, inY    count texels
//   out  outRows     20 rows of count floats: position, flux, normal, radius as gathered; the same of each lane's first
//                    texel, for all lanes
//   Work 2D of one row, one item per LANES numbers; count is a multiple of 16.

#include "probe_params.h"
#include "rsm.clh"

static void writeTexel(__global float* out, int count, RsmTexel t) {
    *(__global vfloat*)(out) = t.positionWs.x;
    *(__global vfloat*)(out + count) = t.positionWs.y;
    *(__global vfloat*)(out + 2 * count) = t.positionWs.z;
    *(__global vfloat*)(out + 3 * count) = t.flux.x;
    *(__global vfloat*)(out + 4 * count) = t.flux.y;
    *(__global vfloat*)(out + 5 * count) = t.flux.z;
    *(__global vfloat*)(out + 6 * count) = t.normalWs.x;
    *(__global vfloat*)(out + 7 * count) = t.normalWs.y;
    *(__global vfloat*)(out + 8 * count) = t.normalWs.z;
    *(__global vfloat*)(out + 9 * count) = t.radius;
}

__kernel void record_probe(RSM_IN(rsm), __global const int* restrict inX, __global const int* restrict inY,
                           __global float* restrict outRows, const ProbeParams params) {
    int i = (int)get_global_id(0) * LANES;
    if (i >= params.count || get_global_id(1) > 0) return;
    vint x = *(__global const vint*)(inX + i), y = *(__global const vint*)(inY + i);
    writeTexel(outRows + i, params.count, rsmGather(rsm, x, y, params.sizePx, 0));
    writeTexel(outRows + 10 * params.count + i, params.count, rsmUniform(rsm, inX[i], inY[i], params.sizePx, 0));
}
