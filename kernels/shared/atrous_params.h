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

typedef struct AtrousParams {
    ViewRays cameraRays;
    i32 radiusX, radiusY;       // [0; 2]: taps on each side
    i32 stepPx;                 // >= 1: from tap to tap; 2 stepPx <= SURFACE_GUARD - LANES
    i32 weights;                // ATROUS_WEIGHTS_*
    f32 share0, share1, share2; // of taps 0, 1 and 2 steps away, in one dimension, before the edges
    f32 depthTolerance;         // > 0; plane: metres off the plane a metre aside; depth: m a step
    f32 normalTolerance;        // > 0: squared difference of unit normals
    f32 luminanceTolerance;     // 0 = off, else standard deviations of the accumulated luminance
    f32 fadeFrames;             // > 0: longer history weakens the taps in proportion
    f32 footprintM;             // width of a pixel: footprintM + depth footprintPerM
    f32 footprintPerM;
    i32 limitsLone;             // 0 or 1: is a lone pixel limited by what is around it?
    i32 padding0, padding1;
} AtrousParams;
ES_ASSERT_SIZE(AtrousParams, 160);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
