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
    f32 inverseNormalTolerance;  // > 0: 1 / squared difference of unit normals from which on they are another's
    i32 weighsTurn;         // 0 or 1: does a tap count for less the more it is turned?
    f32 fireflyFactor;      // 0 = off, else >= 1: times the brightest neighbour
    i32 keepsMoment;        // 0 or 1: are moments asked for?
    i32 padding0, padding1, padding2;
} TemporalParams;
ES_ASSERT_SIZE(TemporalParams, 144);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
