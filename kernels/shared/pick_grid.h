// A picture of lower resolution whose texels are picked pixels of the full one:
//   texel (X, Y) is pixel (X << strideLog2) + offsetXPx, (Y << strideLog2) + offsetYPx
// Picked, not averaged: a mean of two surfaces lies on neither, and a mean of two normals is no normal. And picked at
// fixed places, not by depth: so a texel's ray is a linear function of its place, ViewRays as of any map (pickedRays),
// every stage runs on the smaller picture as it is, and a texel does not jump between pixels from frame to frame.
// What is thin enough to slip through is for the way back to find: bilateral_upsample.cl, interpolate.cl.
#ifndef EARTHSHINE_SHARED_PICK_GRID_H
#define EARTHSHINE_SHARED_PICK_GRID_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct PickGrid {
    i32 strideLog2;  // 0, 1 or 2: every, every second, every fourth pixel
    i32 offsetXPx;   // 0; of every fourth pixel 0 or 1 (pick_grid.clh)
    i32 offsetYPx;
    i32 padding0;
} PickGrid;
ES_ASSERT_SIZE(PickGrid, 16);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
