#pragma once
// Where an OpenGL context without a window comes from. Each platform's library is opened at run time and never linked,
// so that the program starts on a machine that has none of them.

#include <memory>
#include <optional>
#include <string>

namespace earthshine::raster {

/// One context of OpenGL 3.3 core or later, made by a platform.
class GlPlatform {
public:
    GlPlatform() = default;
    virtual ~GlPlatform() = default;
    GlPlatform(const GlPlatform&) = delete;
    GlPlatform& operator=(const GlPlatform&) = delete;

    virtual void bind() = 0;             ///< makes the context current in this thread; throws DeviceError
    virtual void unbind() noexcept = 0;  ///< leaves this thread without a context
    virtual void* getProcAddress(const char* name) const = 0;
    virtual void* nativeContext() const = 0;  ///< EGLContext or OSMesaContext
    virtual void* nativeDisplay() const = 0;  ///< EGLDisplay, or null
    virtual std::string name() const = 0;     ///< "egl", "egl-device:0", "osmesa"
};

/// Which EGL devices to try, in the order in which EGL lists them.
enum class EglDevices { Hardware, All };

/// EGL_MESA_platform_surfaceless. All of these throw DeviceError with one line that says what failed.
std::unique_ptr<GlPlatform> openEglSurfaceless();

/// EGL_EXT_platform_device: the first device that gives a context, hardware before software; or the device `index`.
std::unique_ptr<GlPlatform> openEglDevice(EglDevices devices, std::optional<int> index = std::nullopt);

/// OSMesa: Mesa's software renderer without any window system; last shipped with Mesa 25.0.
std::unique_ptr<GlPlatform> openOsmesa();

}  // namespace earthshine::raster
