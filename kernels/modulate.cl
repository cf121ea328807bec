// modulate: from irradiance on a diffuse surface to the radiance that leaves it.
//   L = albedo / pi E + addend
//   in   inAlbedo      diffuse reflectance, linear, [0; 1]
//   in   inIrradiance  lx
//   in   inAddend      cd/m^2: emission, or light already summed; read only if addsAddend
//   out  outRadiance   cd/m^2
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "math.clh"
#include "modulate_params.h"
#include "surface.clh"

__kernel void modulate(SURFACE_IN(inAlbedo), SURFACE_IN(inIrradiance), SURFACE_IN(inAddend), SURFACE_OUT(outRadiance),
                       const ModulateParams params) {
    Pixel px = itemPixel();
    if (isOutside(px, outRadianceLayout)) return;
    vfloat3 radiance = mul3(scale3((vfloat)(ES_INV_PI), load3(inAlbedo, px)), load3(inIrradiance, px));
    if (params.addsAddend) radiance = add3(radiance, load3(inAddend, px));
    store3(outRadiance, px, radiance);
}
