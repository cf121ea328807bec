// Parameters of rsm_gather.cl.
#ifndef EARTHSHINE_SHARED_RSM_GATHER_PARAMS_H
#define EARTHSHINE_SHARED_RSM_GATHER_PARAMS_H

#include "dialect.h"
#include "light_params.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct RsmGatherParams {
    ViewRays cameraRays;
    i32 rsmSizePx;    // side of one light's map as gathered from
    i32 lightCount;   // >= 0
    i32 sampleCount;  // a light, [1; 4096]
    f32 radiusUv;     // (0; 2], fraction of the map's side
    i32 rotation;     // ROTATION_*: how each pixel moves the pattern; the kernel's ROTATION
    f32 frameShift;   // [0; 1 / sampleCount): this frame moves u by it, of all pixels
    f32 frameTurnCos, frameTurnSin;  // and the pattern by this turn
    f32 mapScale;     // (0.1; 1]: a light's projection fills this part of the map's side, less where blocks stick out
    i32 mapping;      // MAPPING_*: from the pattern's u to radii; the kernel's MAPPING
    i32 padding0, padding1;
} RsmGatherParams;
ES_ASSERT_SIZE(RsmGatherParams, 144);

#define ROTATION_OFF 0    // not: half a step along u
#define ROTATION_NOISE 1  // by its noise
#define ROTATION_TILE 2   // turns it by one of 16 angles, in an order of 4 x 4 pixels; half a step along u

#define ROTATION_NOISE_SIZE_PX 64

// r of u in [0; 1), of the unit disk.
#define MAPPING_AREA 0     // sqrt(u): uniform by area
#define MAPPING_POLAR 1    // u: uniform by radius
#define MAPPING_SQUARED 2  // u^2: crowded at the centre

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
