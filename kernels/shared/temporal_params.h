// Parameters of temporal.cl.
#ifndef EARTHSHINE_SHARED_TEMPORAL_PARAMS_H
#define EARTHSHINE_SHARED_TEMPORAL_PARAMS_H

#include "dialect.h"
#include "view_rays.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct TemporalParams {
    ViewRays previousRays;  // of the previous frame's camera
    i32 hasHistory;         // 0 or 1: a first frame has none
    i32 hasMotion;          // 0 or 1: without motion vectors every pixel stays where it is
    i32 usesConfidence;     // 0 or 1: history_check.cl ran after the previous frame
    f32 maxFrames;          // [1; 1024]: frames that history is worth at most
    f32 planeTolerance;     // > 0, of the distance: how far off the surface's plane a tap may lie
    f32 minNormalCosine;    // [-1; 1]: between the surface's normal then and now
    f32 fireflyFactor;      // 0 = off, else >= 1: times the brightest neighbour
    i32 keepsMoment;        // 0 or 1: are moments asked for?
} TemporalParams;
ES_ASSERT_SIZE(TemporalParams, 128);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
