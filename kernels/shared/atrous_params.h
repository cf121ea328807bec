// Parameters of atrous.cl and atrous_pair.cl.
#ifndef EARTHSHINE_SHARED_ATROUS_PARAMS_H
#define EARTHSHINE_SHARED_ATROUS_PARAMS_H

#include "dialect.h"
#include "view_rays.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

// Of atrous_pair.cl. A GPU's items have one pixel of a row; their groups are pieces of it. Items of several lanes are a
// CPU's: wide strips, since memory comes in along rows, on a stack that CPU drivers keep for every item of a group.
#define ATROUS_PAIR_STRIP(LANES) ((LANES) == 1 ? 1 : 16)   // vectors of LANES pixels an item
#define ATROUS_PAIR_GROUP(LANES) ((LANES) == 1 ? 128 : 1)  // items a group, in x
#define ATROUS_PAIR_MOST_STEP 32                           // with LANES 1: what a group of this keeps in local memory:
#define ATROUS_PAIR_PIECE_PX (ATROUS_PAIR_GROUP(1) + 4 * ATROUS_PAIR_MOST_STEP)  // two rows of so many pixels, and
#define ATROUS_PAIR_LOCAL_BYTES (2 * ATROUS_PAIR_PIECE_PX * 32)                  // 32 bytes a pixel

#define ATROUS_WEIGHTS_PLANE 0
#define ATROUS_WEIGHTS_DEPTH 1

typedef struct AtrousParams {
    ViewRays cameraRays;
    i32 radiusX, radiusY;       // [0; 2]: taps on each side; atrous_pair has 2 and 2
    i32 stepPx;                 // >= 1: from tap to tap; 2 stepPx <= SURFACE_GUARD - LANES
    i32 weights;                // ATROUS_WEIGHTS_*
    f32 share0, share1, share2; // of taps 0, 1 and 2 steps away, in one dimension, before the edges
    f32 depthTolerance;         // > 0; plane: metres off the plane a metre aside; depth: m a step
    f32 inverseNormalTolerance; // 1 / squared difference of unit normals
    f32 luminanceTolerance;     // 0 = off, else standard deviations of the accumulated luminance
    f32 fadeFrames;             // > 0: longer history weakens the taps in proportion
    f32 footprintM;             // width of a pixel: footprintM + depth footprintPerM
    f32 footprintPerM;
    f32 inverseStep;            // 1 / stepPx
    i32 limitsLone;             // 0 or 1: is a lone pixel limited by what is around it? atrous_pair's LIMITS_LONE
    i32 pairRows;               // atrous_pair: rows of an item, > 0
} AtrousParams;
ES_ASSERT_SIZE(AtrousParams, 160);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
