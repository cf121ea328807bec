// struct_probe: how this compiler lays out what C++ fills in.
//   in   light       LightParams by value, inLight the same through memory
//   out  outNumbers  for each line of struct_fields.h: a struct's size, or a field's offset (bytes); then the words of
//                    `light` and those of inLight
//   Work: one item.

#include "atrous_params.h"
#include "direct_light_params.h"
#include "downsample_params.h"
#include "exposure_params.h"
#include "history_check_params.h"
#include "interpolate_params.h"
#include "light_params.h"
#include "modulate_params.h"
#include "pick_grid.h"
#include "rsm_choose_params.h"
#include "rsm_gather_params.h"
#include "rsm_pack_params.h"
#include "rsm_sum_params.h"
#include "surface_layout.h"
#include "temporal_params.h"
#include "tile_average_params.h"
#include "tone_map_params.h"
#include "unpack_params.h"
#include "bilateral_upsample_params.h"

__kernel void struct_probe(const LightParams light, __global const LightParams* restrict inLight,
                           __global uint* restrict outNumbers) {
    if (get_global_id(0) > 0 || get_global_id(1) > 0) return;
    int n = 0;
#define ES_STRUCT(T) outNumbers[n++] = (uint)sizeof(T);
#define ES_FIELD(T, F) { T t; outNumbers[n++] = (uint)((size_t)&t.F - (size_t)&t); }
#include "struct_fields.h"
    *(__global LightParams*)(outNumbers + (n + 3) / 4 * 4) = light;
    *(__global LightParams*)(outNumbers + (n + 3) / 4 * 4 + sizeof(LightParams) / 4) = *inLight;
}
