// Parameters of bilateral_upsample.cl.
#ifndef EARTHSHINE_SHARED_BILATERAL_UPSAMPLE_PARAMS_H
#define EARTHSHINE_SHARED_BILATERAL_UPSAMPLE_PARAMS_H

#include "dialect.h"
#include "pick_grid.h"
#include "view_rays.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct BilateralUpsampleParams {
    ViewRays cameraRays;  // of the full picture
    PickGrid grid;
} BilateralUpsampleParams;
ES_ASSERT_SIZE(BilateralUpsampleParams, 112);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
