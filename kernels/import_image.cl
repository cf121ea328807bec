// import_image: an image that another API drew into (OpenGL's textures), into a surface.
//   The second door of the OpenCL half, with the same rule as unpack: what is not finite becomes 0 and the rest is cut
//   to +-1e15. The pass also sets the texture free: it is held for its length alone, and the frame's normals and depths
//   are still here when the next frame is drawn over them.
//   in   image   R32F, RGBA16F or RGBA32F, row 0 at the top, of the surface's extent
//   out  outSurface   one number a pixel of R32F, else three (alpha is dropped)
//   Work 2D, one item per LANES pixels of a row, any local size; items past the edge return.

#include "sanitised.clh"
#include "surface.clh"

__constant sampler_t importSampler = CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_CLAMP_TO_EDGE | CLK_FILTER_NEAREST;

__kernel void import_image(__read_only image2d_t image, SURFACE_OUT(outSurface), const int channelCount) {
    Pixel px = itemPixel();
    if (isOutside(px, outSurfaceLayout)) return;
    vfloat3 v;
#if LANES == 1
    float4 texel = read_imagef(image, importSampler, (int2)(px.x, px.y));
    v = make3(texel.x, texel.y, texel.z);
#else
    VfloatLanes r, g, b;
    for (int i = 0; i < LANES; ++i) {
        float4 texel = read_imagef(image, importSampler, (int2)(px.x + i, px.y));  // the sampler keeps x on the row
        r.lane[i] = texel.x;
        g.lane[i] = texel.y;
        b.lane[i] = texel.z;
    }
    v = make3(r.v, g.v, b.v);
#endif
    if (channelCount == 1)
        store1(outSurface, px, sanitised(v.x));
    else
        store3(outSurface, px, make3(sanitised(v.x), sanitised(v.y), sanitised(v.z)));
}
