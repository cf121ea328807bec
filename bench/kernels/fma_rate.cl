// fma_rate: multiplications and additions that wait for nothing but each other: 12 chains of them an item, since a unit
// that takes 4 to 5 clocks for one and begins one or two a clock needs 10 under way, and 12 with their two factors still
// fit the 16 registers of AVX2.
//   x = factor x + addend, `steps` times, which tends to addend / (1 - factor): nothing overflows or becomes denormal
//   out  outSums   one float an item
//   Work: itemCount items in all, any local size; items past them return.

#include "lanes.clh"

// Not an array: some compilers would keep one in memory.
#define EACH_CHAIN(DO) DO(a) DO(b) DO(c) DO(d) DO(e) DO(f) DO(g) DO(h) DO(i) DO(j) DO(k) DO(l)
#define START(X) vfloat X = start; start += 1.0f;
#define STEP(X) X = vmad(X, factor, addend);
#define ADD(X) sum += X;

__kernel void fma_rate(__global float* restrict outSums, const int itemCount, const int steps, const float factor,
                       const float addend) {
    int item = (int)(get_global_id(1) * get_global_size(0) + get_global_id(0));
    if (item >= itemCount) return;
    vfloat start = toVfloat(laneIndex() + item), sum = 0.0f;
    EACH_CHAIN(START)
    for (int n = 0; n < steps; ++n) {
        EACH_CHAIN(STEP)
    }
    EACH_CHAIN(ADD)
    outSums[item] = sumLanes(sum);
}
