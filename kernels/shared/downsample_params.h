// Parameters of downsample.cl.
#ifndef EARTHSHINE_SHARED_DOWNSAMPLE_PARAMS_H
#define EARTHSHINE_SHARED_DOWNSAMPLE_PARAMS_H

#include "dialect.h"
#include "pick_grid.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct DownsampleParams {
    PickGrid grid;
    i32 picksMotion;  // 0 or 1
    i32 padding0, padding1, padding2;
} DownsampleParams;
ES_ASSERT_SIZE(DownsampleParams, 32);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
