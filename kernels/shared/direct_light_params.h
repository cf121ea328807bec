// Parameters of direct_light.cl.
#ifndef EARTHSHINE_SHARED_DIRECT_LIGHT_PARAMS_H
#define EARTHSHINE_SHARED_DIRECT_LIGHT_PARAMS_H

#include "dialect.h"
#include "light_params.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct DirectLightParams {
    ViewRays cameraRays;
    i32 lightCount;               // >= 0
    i32 shadowWidthPx;            // one light's shadow map
    i32 shadowHeightPx;
    f32 shadowBiasTexels;         // [0; 16]
    f32 shadowSlopeBiasTexels;    // [0; 16], a unit of slope
    i32 padding0, padding1, padding2;
} DirectLightParams;
ES_ASSERT_SIZE(DirectLightParams, 128);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
