// tone_map: from scene-linear radiance to the bytes of an sRGB display.
//   filmic: (x (2.51 x + 0.03)) / (x (2.43 x + 0.59) + 0.14), Narkowicz 2015, "ACES Filmic Tone Mapping Curve"
//   srgb:   clipped at 1
//   then the sRGB transfer function of IEC 61966-2-1.
//   in   inRadiance  cd/m^2
//   in   exposure    one float
//   out  outDisplay  RGBA8, rows top to bottom without padding; alpha 255
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "math.clh"
#include "surface.clh"
#include "tone_map_params.h"

static vint displayByte(vfloat x, int curve) {
    x = max(x, 0.0f);
    if (curve == TONE_CURVE_FILMIC) {
        x = min(x, 1e6f);  // far beyond white: the squares of larger ones overflow
        x = x * vmad(2.51f, x, 0.03f) / vmad(x, vmad(2.43f, x, 0.59f), 0.14f);
    }
    x = min(x, 1.0f);
    vfloat encoded = vselect(x <= 0.0031308f, 12.92f * x, vmad(1.055f, es_pow(x, 1.0f / 2.4f), -0.055f));
    return toVint(vmad(encoded, 255.0f, 0.5f));
}

__kernel void tone_map(SURFACE_IN(inRadiance), __global const float* restrict exposure,
                       __global uchar4* restrict outDisplay, const ToneMapParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, inRadianceLayout)) return;
    vfloat3 color = scale3((vfloat)(*exposure), load3(inRadiance, px));
    VintLanes r, g, b;
    r.v = displayByte(color.x, params.curve);
    g.v = displayByte(color.y, params.curve);
    b.v = displayByte(color.z, params.curve);
    for (int i = 0; i < min(LANES, inRadianceLayout.widthPx - px.x); ++i)
        outDisplay[px.y * inRadianceLayout.widthPx + px.x + i] =
            (uchar4)(r.lane[i], g.lane[i], b.lane[i], 255);
}
