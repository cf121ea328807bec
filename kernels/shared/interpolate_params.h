// Parameters of interpolate.cl.
#ifndef EARTHSHINE_SHARED_INTERPOLATE_PARAMS_H
#define EARTHSHINE_SHARED_INTERPOLATE_PARAMS_H

#include "dialect.h"
#include "pick_grid.h"
#include "view_rays.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct InterpolateParams {
    ViewRays cameraRays;  // of the full picture
    PickGrid grid;
    f32 minCosine;       // [0; 1]: normals that differ by more do not agree
    f32 maxPlaneTexels;  // > 0: nor does what lies farther from the pixel's plane, in widths of a texel there
    i32 padding0, padding1;
} InterpolateParams;
ES_ASSERT_SIZE(InterpolateParams, 128);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
