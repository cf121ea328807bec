// How a surface lies in memory. An image needs only its extent, packed pixels their pitch too; planes need all four.
#ifndef EARTHSHINE_SHARED_SURFACE_LAYOUT_H
#define EARTHSHINE_SHARED_SURFACE_LAYOUT_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

#define STORAGE_IMAGE 0
#define STORAGE_PLANAR 1
#define STORAGE_PACKED 2

// Pixels before the first row and after the last one (floats around all planes), so that a load that leaves its row by
// this much still reads memory of the surface: neighbours' pixels or zeros, which the kernel masks.
#define SURFACE_GUARD 512

typedef struct SurfaceLayout {
    i32 widthPx;
    i32 heightPx;
    i32 pitch;        // pixels from a row to the next: widthPx rounded up to 16, so that no lane falls off a row
    i32 planeStride;  // floats from a channel's plane to the next
} SurfaceLayout;
ES_ASSERT_SIZE(SurfaceLayout, 16);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
