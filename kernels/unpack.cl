// unpack: plain pixels, as the host or GL hands them over, into a surface.
//   The door of the OpenCL half: what is not finite becomes 0 here and the rest is cut to +-1e15, so that no later stage
//   meets a NaN or an infinity, nor makes one.
//   in   pixels   UnpackParams.format, rows top to bottom without padding
//   out  outSurface   the rows [firstRowPx; firstRowPx + heightPx); one number a pixel of R32F, else three (alpha is dropped)
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "sanitised.clh"
#include "surface.clh"
#include "unpack_params.h"

static vfloat floatFromHalf(vuint half_) {
    vuint magnitude = half_ & 0x7fffu;
    vfloat v = asVfloat(magnitude << 13) * 0x1p112f;  // moved into place: 2^-112 of its value
    v = vselect(asVint(magnitude) >= 0x7c00, 0.0f, v);  // infinity and NaN
    return asVfloat(asVuint(v) | ((half_ & 0x8000u) << 16));
}

// LANES neighbouring pixels of four channels each, one vector a channel, from LANES * 4 elements at `from`.
#if LANES == 1
#define DEINTERLEAVE(CONVERT, LOAD, FROM, R, G, B)      \
    R = CONVERT((FROM)[0]);                             \
    G = CONVERT((FROM)[1]);                             \
    B = CONVERT((FROM)[2]);
#else
#if LANES == 4
#define CHANNEL(I0, I1, I2, I3, A, B, C, D) (A.s##I0, B.s##I0, C.s##I0, D.s##I0)
#elif LANES == 8
#define CHANNEL(I0, I1, I2, I3, A, B, C, D) (A.s##I0##I1, B.s##I0##I1, C.s##I0##I1, D.s##I0##I1)
#else
#define CHANNEL(I0, I1, I2, I3, A, B, C, D) \
    (A.s##I0##I1##I2##I3, B.s##I0##I1##I2##I3, C.s##I0##I1##I2##I3, D.s##I0##I1##I2##I3)
#endif
#define DEINTERLEAVE(CONVERT, T, FROM, R, G, B)                                                       \
    {                                                                                                 \
        T p0 = ES_WIDE(vload)(0, FROM), p1 = ES_WIDE(vload)(1, FROM);                                 \
        T p2 = ES_WIDE(vload)(2, FROM), p3 = ES_WIDE(vload)(3, FROM);                                 \
        R = CONVERT((T)CHANNEL(0, 4, 8, c, p0, p1, p2, p3));                                          \
        G = CONVERT((T)CHANNEL(1, 5, 9, d, p0, p1, p2, p3));                                          \
        B = CONVERT((T)CHANNEL(2, 6, a, e, p0, p1, p2, p3));                                          \
    }
#endif

#define HALVES_TO_FLOATS(V) floatFromHalf(ES_WIDE(convert_uint)(V))

__kernel void unpack(__global const uchar* restrict pixels, SURFACE_OUT(outSurface), const UnpackParams params) {
    Pixel px = itemPixel();
    if (px.x >= params.widthPx || px.y >= params.heightPx) return;
    int first = px.y * params.widthPx + px.x;
    bool isWhole = px.x + LANES <= params.widthPx;  // uniform: the last item of a row may have fewer pixels than lanes
    vfloat3 v = make3(0.0f, 0.0f, 0.0f);

    if (params.format == UNPACK_R32F) {
        __global const float* from = (__global const float*)pixels + first;
        if (isWhole) {
#if LANES == 1
            v.x = *from;
#else
            v.x = ES_WIDE(vload)(0, from);
#endif
        } else {
            VfloatLanes u;
            u.v = 0.0f;
            for (int i = 0; i < params.widthPx - px.x; ++i) u.lane[i] = from[i];
            v.x = u.v;
        }
    } else if (isWhole) {
        if (params.format == UNPACK_RGBA16F) {
            __global const ushort* from = (__global const ushort*)pixels + 4 * first;
            DEINTERLEAVE(HALVES_TO_FLOATS, ES_WIDE(ushort), from, v.x, v.y, v.z)
        } else {
            __global const float* from = (__global const float*)pixels + 4 * first;
            DEINTERLEAVE(, vfloat, from, v.x, v.y, v.z)
        }
    } else {
        VfloatLanes r, g, b;
        r.v = g.v = b.v = 0.0f;
        for (int i = 0; i < params.widthPx - px.x; ++i) {
            float4 texel = params.format == UNPACK_RGBA16F
                               ? vload_half4(first + i, (__global const half*)pixels)
                               : vload4(first + i, (__global const float*)pixels);
            r.lane[i] = texel.x;
            g.lane[i] = texel.y;
            b.lane[i] = texel.z;
        }
        v = make3(r.v, g.v, b.v);
    }
    v = make3(sanitised(v.x), sanitised(v.y), sanitised(v.z));

    px.y += params.firstRowPx;
    if (params.format == UNPACK_R32F)
        store1(outSurface, px, v.x);
    else
        store3(outSurface, px, v);
}
