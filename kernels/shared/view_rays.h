// Where a texel of a camera's or a light's map lies in the world, given its linear depth:
//   x(px, depth) = origin + px.x originDx + px.y originDy + depth (ray + px.x rayDx + px.y rayDy)
// px is the integer texel; the half texel to its centre is folded in. Perspective: originDx = originDy = 0;
// orthographic: rayDx = rayDy = 0. All world space, w unused.
#ifndef EARTHSHINE_SHARED_VIEW_RAYS_H
#define EARTHSHINE_SHARED_VIEW_RAYS_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct ViewRays {
    f32x4 origin, originDx, originDy;  // m
    f32x4 ray, rayDx, rayDy;           // m a metre of depth
} ViewRays;
ES_ASSERT_SIZE(ViewRays, 96);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
