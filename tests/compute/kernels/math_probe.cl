// math_probe: one of math.clh's functions of many numbers.
//   in   inX, inY    count floats
//   out  outValues   count floats; function: 0 exp2, 1 log2, 2 exp, 3 pow, 4 sinTau, 5 cosTau
//   Work 2D of one row, one item per LANES numbers; count is a multiple of 16.

#include "math.clh"
#include "probe_params.h"

__kernel void math_probe(__global const float* restrict inX, __global const float* restrict inY,
                         __global float* restrict outValues, const ProbeParams params) {
    int i = (int)get_global_id(0) * LANES;
    if (i >= params.count || get_global_id(1) > 0) return;
    vfloat x = *(__global const vfloat*)(inX + i), y = *(__global const vfloat*)(inY + i);
    vfloat v = 0.0f;
    if (params.function == 0) v = es_exp2(x);
    if (params.function == 1) v = es_log2(x);
    if (params.function == 2) v = es_exp(x);
    if (params.function == 3) v = es_pow(x, y);
    if (params.function == 4) v = es_sinTau(x);
    if (params.function == 5) v = es_cosTau(x);
    *(__global vfloat*)(outValues + i) = v;
}
