#pragma once
// What of OpenGL the library touches, without linking it: the textures of a frame, and how to find GL's functions.

#include <functional>
#include <string>

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

/// Where a GL context comes from; OpenCL shares with some of them.
enum class GlPlatformKind { Egl, Glx, Other };

/// A GL context as those see it who share its textures.
struct GlContextHandle {
    GlGetProcAddress getProcAddress;
    GlPlatformKind platform = GlPlatformKind::Other;
    void* context = nullptr;  ///< EGLContext or GLXContext
    void* display = nullptr;  ///< EGLDisplay or X11's Display*
    std::string renderer;     ///< GL_RENDERER, for messages
};

/// Where a renderer's textures get their memory from, if OpenCL is to share it.
class GlTextureStorage {
public:
    virtual ~GlTextureStorage() = default;

    /// Gives the texture, which is bound to GL_TEXTURE_2D and has no storage yet, one level of this format and extent.
    /// Returns false if any storage will do: the caller then makes it. Throws DeviceError.
    virtual bool allocate(const GlTexture& texture) = 0;

    /// The texture will be deleted, or its name given other storage: what was shared of it is let go.
    virtual void forget(unsigned name) noexcept = 0;
};

}  // namespace earthshine
