// Parameters of rsm_pack.cl and rsm_minify.cl, and the record that they write.
#ifndef EARTHSHINE_SHARED_RSM_PACK_PARAMS_H
#define EARTHSHINE_SHARED_RSM_PACK_PARAMS_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct RsmPackParams {
    i32 sizePx;      // side of one light's map
    i32 lightCount;  // maps below one another
    i32 minify;      // rsm_minify: side of a block of texels, [1; 8]
    u32 seed;        // rsm_minify: of which texel of a block is picked
} RsmPackParams;
ES_ASSERT_SIZE(RsmPackParams, 16);

// One texel as the gather reads it: one aligned fetch of 32 bytes.
typedef struct RsmRecord {
    f32 positionX, positionY, positionZ;  // m, world space
    f32 fluxR, fluxG, fluxB;              // lm; 0 where the light meets nothing
    u32 normalXy;                         // two snorm16, world space
    u32 normalZRadius;                    // snorm16 | half << 16: sqrt(area / pi) of the texel on its surface, m
} RsmRecord;
ES_ASSERT_SIZE(RsmRecord, 32);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
