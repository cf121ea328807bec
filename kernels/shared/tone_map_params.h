// Parameters of tone_map.cl.
#ifndef EARTHSHINE_SHARED_TONE_MAP_PARAMS_H
#define EARTHSHINE_SHARED_TONE_MAP_PARAMS_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

#define TONE_CURVE_FILMIC 0
#define TONE_CURVE_SRGB 1

typedef struct ToneMapParams {
    i32 curve;  // TONE_CURVE_*
    i32 padding0, padding1, padding2;
} ToneMapParams;
ES_ASSERT_SIZE(ToneMapParams, 16);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
