// Parameters of rsm_sum.cl.
#ifndef EARTHSHINE_SHARED_RSM_SUM_PARAMS_H
#define EARTHSHINE_SHARED_RSM_SUM_PARAMS_H

#include "dialect.h"
#include "light_params.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct RsmSumParams {
    ViewRays cameraRays;
    i32 rsmSizePx;   // side of one light's map
    i32 lightCount;  // >= 0
    i32 firstRowPx;  // of the target: a launch does the rows from here on
    i32 padding0;
} RsmSumParams;
ES_ASSERT_SIZE(RsmSumParams, 112);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
