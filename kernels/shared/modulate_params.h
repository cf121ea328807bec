// Parameters of modulate.cl.
#ifndef EARTHSHINE_SHARED_MODULATE_PARAMS_H
#define EARTHSHINE_SHARED_MODULATE_PARAMS_H

#include "dialect.h"

#ifndef ES_DIALECT_CL
namespace earthshine {
#endif

typedef struct ModulateParams {
    i32 addsAddend;  // 0 or 1
    i32 padding0, padding1, padding2;
} ModulateParams;
ES_ASSERT_SIZE(ModulateParams, 16);

#ifndef ES_DIALECT_CL
}  // namespace earthshine
#endif

#endif
