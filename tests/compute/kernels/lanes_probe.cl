// lanes_probe: what the dialect's vector helpers make of two rows of numbers.
//   in   inA, inB    count floats
//   out  outRows     LANES_ROWS rows of count floats (probe_params.h)
//   Work 2D of one row, one item per LANES numbers; count is a multiple of 16.

#include "probe_params.h"
#include "vec3.clh"

__kernel void lanes_probe(__global const float* restrict inA, __global const float* restrict inB,
                          __global float* restrict outRows, const ProbeParams params) {
    int i = (int)get_global_id(0) * LANES;
    if (i >= params.count || get_global_id(1) > 0) return;
    vfloat a = *(__global const vfloat*)(inA + i), b = *(__global const vfloat*)(inB + i);
    vmask less = a < b;
    vfloat3 p = make3(a, b, a - b), q = make3(b, b, a);
    vfloat rows[LANES_ROWS];
    rows[LANES_SELECT] = vselect(less, a, b);
    rows[LANES_SELECT_AND] = vselect((a >= b) & (a > 0.0f) | (a < -0.5f), a, b);
    rows[LANES_ANY] = anyLane(a > 0.75f) ? 1.0f : 0.0f;
    rows[LANES_SUM] = sumLanes(a);
    rows[LANES_INDEX] = toVfloat((vint)(laneIndex()));
    rows[LANES_BITS] = asVfloat(asVuint(a) ^ 0x80000000u);
    rows[LANES_TO_INT] = toVfloat(toVint(a * 100.0f));
    rows[LANES_DOT3] = dot3(p, q);
    rows[LANES_SELECT3] = select3(less, p, q).z;
    rows[LANES_ROW] = rowTimesPoint((float4)(1.0f, 2.0f, 3.0f, 4.0f), p);
    rows[LANES_LUMINANCE] = luminance(p);
    rows[LANES_SELECT_INT] = toVfloat(vselectInt(less, toVint(a * 100.0f), 7));
    rows[LANES_MAD] = vmad(a, 2.0f, b);
    vfloat twice = vselect(a > 0.6f, NAN, 2.0f * a), infinite = vselect(a > 0.0f, INFINITY, -INFINITY);
    rows[LANES_SATURATE] = vsaturate(twice);
    rows[LANES_SATURATE_INFINITE] = vsaturate(infinite);
    rows[LANES_RECIP] = vrecip(a + 1.5f);
    for (int row = 0; row < LANES_ROWS; ++row) *(__global vfloat*)(outRows + row * params.count + i) = rows[row];
}
