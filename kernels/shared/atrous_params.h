// Parameters of atrous.cl.
#ifndef EARTHSHINE_SHARED_ATROUS_PARAMS_H
#define EARTHSHINE_SHARED_ATROUS_PARAMS_H

#include "dialect.h"
#include "view_rays.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

#define ATROUS_WEIGHTS_PLANE 0
#define ATROUS_WEIGHTS_DEPTH 1

#define ATROUS_MAX_TAPS 25  // of 5 x 5

typedef struct AtrousTap {
    f32 share;          // of the mean, before the edges
    f32 inverseWay2;    // 1 / (i^2 + j^2)
} AtrousTap;
ES_ASSERT_SIZE(AtrousTap, 8);

typedef struct AtrousParams {
    ViewRays cameraRays;
    AtrousTap taps[ATROUS_MAX_TAPS];  // rows of them, from (-radiusX, -radiusY) on; of the middle one only the share counts
    i32 radiusX, radiusY;       // [0; 2]: taps on each side
    i32 stepPx;                 // >= 1: from tap to tap; 2 stepPx <= SURFACE_GUARD - LANES
    i32 weights;                // ATROUS_WEIGHTS_*
    f32 depthTolerance;         // > 0; plane: metres off the plane a metre aside; depth: m a step
    f32 normalTolerance;        // > 0: squared difference of unit normals
    f32 luminanceTolerance;     // 0 = off, else standard deviations of the accumulated luminance
    f32 fadeFrames;             // >= 1: longer history weakens the taps in proportion
    f32 footprintM;             // width of a pixel: footprintM + depth footprintPerM
    f32 footprintPerM;
} AtrousParams;
ES_ASSERT_SIZE(AtrousParams, 336);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
