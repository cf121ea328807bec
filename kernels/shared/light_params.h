// One light, as every kernel that looks at lights reads it.
#ifndef EARTHSHINE_SHARED_LIGHT_PARAMS_H
#define EARTHSHINE_SHARED_LIGHT_PARAMS_H

#include "dialect.h"
#include "view_rays.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

#define LIGHT_DIRECTIONAL 0
#define LIGHT_SPOT 1

typedef struct LightParams {
    // World to the light's maps: dot(row, (x, 1)) with u = U / W, v = V / W; W <= 0 behind a spot.
    f32x4 uRow, vRow, wRow;
    f32x4 depthRow;      // m along the light's -z
    f32x4 towardsLight;  // unit, directional: against the beam; spot: against its axis; w unused
    f32x4 positionWs;    // m, spot; w unused
    f32x4 intensity;     // lux or cd; w unused
    i32 type;            // LIGHT_DIRECTIONAL or LIGHT_SPOT
    f32 coneScale;       // falloff = clamp(cos * coneScale + coneOffset, 0, 1)^2
    f32 coneOffset;
    f32 inverseRange;          // 1/m; 0 = without end
    f32 shadowTexelSize;       // m a texel of the shadow map: directional: everywhere; spot: at 1 m of depth
    f32 rsmTexelArea;          // directional: m^2 across the beam; spot: m^2 at 1 m of depth on the axis
    f32 indirectScale;         // times the light's indirect light
    f32 gatherRadiusUv;        // [0; 2] of the map's side, of its disk; 0 = RsmGatherParams.radiusUv
    ViewRays rsmRays;
} LightParams;
ES_ASSERT_SIZE(LightParams, 240);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
