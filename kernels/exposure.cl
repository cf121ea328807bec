// exposure: the factor that brings a picture's luminance to the display.
//   exposure = 2^stops, or automatic: 2^stops middleGrey / exp(mean log L), Reinhard et al. 2002, eq. 1 and 2.
//   in   cells        luminance_sum's
//   out  outExposure  one float, > 0; 2^stops if no pixel counts
//   Work: one item.

#include "exposure_params.h"
#include "math.clh"

__kernel void exposure(__global const float2* restrict cells, __global float* restrict outExposure,
                       const ExposureParams params) {
    if (get_global_id(0) > 0 || get_global_id(1) > 0) return;
    float2 sum = 0.0f;
    if (params.automatic)
        for (int i = 0; i < LUMINANCE_CELLS_X * LUMINANCE_CELLS_Y; ++i) sum += cells[i];
    float stops = sum.y > 0.0f ? params.stops + log2(params.middleGrey) - sum.x / sum.y : params.stops;
    VfloatLanes factor;
    factor.v = es_exp2((vfloat)(stops));
    *outExposure = factor.lane[0];
}
