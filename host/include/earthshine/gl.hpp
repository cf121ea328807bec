#pragma once
// What of OpenGL the library touches, without linking it: the textures of a frame, and how to find GL's functions.

#include <functional>

#include "earthshine/image.hpp"

namespace earthshine {

/// Finds an entry point in the current context's GL (eglGetProcAddress, OSMesaGetProcAddress, ...); null if not there.
using GlGetProcAddress = std::function<void*(const char* name)>;

/// One GL_TEXTURE_2D, level 0, row 0 at the top of the picture (raster draws upside down for that).
struct GlTexture {
    unsigned name = 0;  ///< 0 = none
    PixelFormat format = PixelFormat::RGBA32F;
    Extent extent;
};

/// The textures that a renderer fills for one frame; contents as in GBuffer and LightMaps (frame.hpp). The maps of all
/// lights stand below one another in one texture each: light i owns the rows [i * h / n; (i + 1) * h / n).
struct GlFrame {
    GlTexture albedo, normalWs, depth, motion, emission;
    GlTexture rsmDepth, rsmNormalWs, rsmFlux, shadowDepth;
    int lightCount = 0;
};

}  // namespace earthshine
