// Parameters of the probes.
#ifndef EARTHSHINE_PROBE_PARAMS_H
#define EARTHSHINE_PROBE_PARAMS_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct ProbeParams {
    i32 function;
    i32 count;
    i32 sizePx;
    i32 padding0;
} ProbeParams;
ES_ASSERT_SIZE(ProbeParams, 16);

// What lanes_probe writes, one row of `count` numbers each.
#define LANES_SELECT 0
#define LANES_SELECT_AND 1
#define LANES_ANY 2
#define LANES_SUM 3
#define LANES_INDEX 4
#define LANES_BITS 5
#define LANES_TO_INT 6
#define LANES_DOT3 7
#define LANES_SELECT3 8
#define LANES_ROW 9
#define LANES_LUMINANCE 10
#define LANES_SELECT_INT 11
#define LANES_MAD 12
#define LANES_SATURATE 13
#define LANES_SATURATE_INFINITE 14
#define LANES_RECIP 15
#define LANES_ROWS 16

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
