// Parameters of rsm_choose.cl and rsm_gather_coherent.cl, and what the one leaves for the other.
#ifndef EARTHSHINE_SHARED_RSM_CHOOSE_PARAMS_H
#define EARTHSHINE_SHARED_RSM_CHOOSE_PARAMS_H

#include "dialect.h"
#include "rsm_gather_params.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct RsmChooseParams {
    RsmGatherParams gather;  // rotation unused
    i32 firstRowPx;          // the launch's rows of the picture: [firstRowPx; firstRowPx + rowCount)
    i32 rowCount;
    f32 frameCentre;  // [0; 1): this frame's part in which sample has which of a set's disks
    i32 padding0;
} RsmChooseParams;
ES_ASSERT_SIZE(RsmChooseParams, 160);

// Pixels x of a row with the same x % COHERENT_STRIDE_PX and the same x / COHERENT_SPAN_PX are a set.
#define COHERENT_STRIDE_PX 4
#define COHERENT_SPAN_PX 64

// A sample of a set: light arrives from this texel, times this weight.
typedef struct RsmChoice {
    i32 texel;   // y size + x over all maps below one another
    f32 weight;  // indirectScale / (pi pdf), >= 0: what texelGeometry times flux is multiplied by
} RsmChoice;
ES_ASSERT_SIZE(RsmChoice, 8);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
