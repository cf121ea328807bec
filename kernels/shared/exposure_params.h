// Parameters of luminance_sum.cl and exposure.cl.
#ifndef EARTHSHINE_SHARED_EXPOSURE_PARAMS_H
#define EARTHSHINE_SHARED_EXPOSURE_PARAMS_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

#define LUMINANCE_CELLS_X 32
#define LUMINANCE_CELLS_Y 32

typedef struct ExposureParams {
    i32 automatic;  // 0 or 1
    f32 stops;      // [-32; 32]
    f32 middleGrey; // (0; 1): what the log-average luminance becomes
    i32 padding0;
} ExposureParams;
ES_ASSERT_SIZE(ExposureParams, 16);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
