#pragma once
// An OpenGL context without a window, its functions and what can be said about it.

#include <memory>
#include <string>
#include <string_view>

#include "raster/gl/gl_functions.hpp"
#include "raster/gl/platform.hpp"

namespace earthshine::raster {

/// What a context is, in the words of its driver.
struct GlDescription {
    std::string platform;  ///< "egl", "egl-device:0", "osmesa"
    std::string vendor;
    std::string renderer;
    std::string version;
    bool isSoftware = false;  ///< llvmpipe, softpipe, swrast
    int maxTextureSizePx = 0;
};

/// An OpenGL 3.3 core context, to be used by one thread at a time. It must outlive every object made in it.
class GlContext {
public:
    explicit GlContext(std::unique_ptr<GlPlatform> platform);  ///< leaves it current; throws DeviceError
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// Makes this context current in the calling thread, in place of any other GlContext; cheap if it already is.
    void makeCurrent();

    /// Finds entry points of this context; use it while the context is current.
    GlGetProcAddress getProcAddress() const;

    const GlFunctions& gl() const noexcept { return functions_; }
    const GlDescription& description() const noexcept { return description_; }
    /// This context for those who share its textures. Valid while it lives.
    GlContextHandle handle() const;

    /// Who gives the textures of render targets their memory; null (as at birth): GL alone. It must outlive every
    /// render target of this context.
    void setTextureStorage(GlTextureStorage* storage) noexcept { textureStorage_ = storage; }
    GlTextureStorage* textureStorage() const noexcept { return textureStorage_; }

    void* nativeContext() const { return platform_->nativeContext(); }  ///< EGLContext or OSMesaContext
    void* nativeDisplay() const { return platform_->nativeDisplay(); }  ///< EGLDisplay; null on OSMesa

    /// Throws DeviceError if GL recorded an error since the last call: `where`, the code, the driver's own message if
    /// it gives one (KHR_debug), and the renderer.
    void check(std::string_view where);

private:
    void listenForMessages();

    std::unique_ptr<GlPlatform> platform_;
    GlFunctions functions_;
    GlDescription description_;
    GlTextureStorage* textureStorage_ = nullptr;
    std::string driverMessage_;  ///< the driver's last word about an error
};

/// Makes a context and leaves it current. `which`:
///   "auto"          a hardware EGL device, else "egl", else "egl-device", else "osmesa"
///   "egl"           EGL_MESA_platform_surfaceless
///   "egl-device"    EGL_EXT_platform_device, hardware first; "egl-device:N" is the device N as EGL numbers them
///   "osmesa"        OSMesa
/// Logs the choice in one line. Throws UsageError for another word, and DeviceError with one line that says what was
/// tried and why each failed.
std::unique_ptr<GlContext> createContext(std::string_view which);

}  // namespace earthshine::raster
