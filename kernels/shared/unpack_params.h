// Parameters of unpack.cl.
#ifndef EARTHSHINE_SHARED_UNPACK_PARAMS_H
#define EARTHSHINE_SHARED_UNPACK_PARAMS_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

#define UNPACK_R32F 0
#define UNPACK_RGBA16F 1
#define UNPACK_RGBA32F 2

typedef struct UnpackParams {
    i32 format;      // UNPACK_*
    i32 firstRowPx;  // row of the surface that receives the first row of pixels
    i32 widthPx, heightPx;  // of the pixels
} UnpackParams;
ES_ASSERT_SIZE(UnpackParams, 16);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
