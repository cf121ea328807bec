// Parameters of tile_average.cl.
#ifndef EARTHSHINE_SHARED_TILE_AVERAGE_PARAMS_H
#define EARTHSHINE_SHARED_TILE_AVERAGE_PARAMS_H

#include "dialect.h"
#include "view_rays.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct TileAverageParams {
    ViewRays cameraRays;
    f32 minNormalCosine;  // [-1; 1]: between a pixel's normal and a tap's
    f32 planeTolerance;   // > 0: metres off the pixel's plane a metre aside
    f32 footprintM;       // width of a pixel: footprintM + depth footprintPerM
    f32 footprintPerM;
} TileAverageParams;
ES_ASSERT_SIZE(TileAverageParams, 112);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
