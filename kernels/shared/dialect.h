// The types that a parameter struct may hold, in both languages: OpenCL C (built with -DES_DIALECT_CL, since predefined macros differ between compilers) and C++.
// Only 4-byte scalars and 16-byte vectors of four, so that every compiler lays a struct out the same way.
#ifndef EARTHSHINE_SHARED_DIALECT_H
#define EARTHSHINE_SHARED_DIALECT_H

#ifdef ES_DIALECT_CL
typedef int i32;
typedef uint u32;
typedef float f32;
typedef int4 i32x4;
typedef float4 f32x4;
#define ES_ASSERT_SIZE(T, BYTES) typedef char T##HasThatSize[sizeof(T) == (BYTES) ? 1 : -1]
#else
#include <cstdint>
namespace earthshine {
using i32 = std::int32_t;
using u32 = std::uint32_t;
using f32 = float;
struct alignas(16) i32x4 {
    i32 x, y, z, w;
};
struct alignas(16) f32x4 {
    f32 x, y, z, w;
};
}  // namespace earthshine
#define ES_ASSERT_SIZE(T, BYTES) static_assert(sizeof(T) == (BYTES))
#endif

#endif
