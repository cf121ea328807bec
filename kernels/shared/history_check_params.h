// Parameters of history_confidence.cl, and the tiles of history_check.cl.
#ifndef EARTHSHINE_SHARED_HISTORY_CHECK_PARAMS_H
#define EARTHSHINE_SHARED_HISTORY_CHECK_PARAMS_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

#define CONFIDENCE_TILE_PX 16  // side of a tile; a work-item's lanes lie in one

typedef struct HistoryCheckParams {
    f32 keptBelow;     // ratios up to this one are noise: confidence 1
    f32 droppedAbove;  // > keptBelow: ratios from this one on are change: confidence 0
    i32 columns, rows;  // of tiles
} HistoryCheckParams;
ES_ASSERT_SIZE(HistoryCheckParams, 16);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
