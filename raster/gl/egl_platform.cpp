// EGL contexts without a window: Mesa's surfaceless platform, and EGL devices (GPUs of any vendor, or llvmpipe).

#include <algorithm>
#include <string_view>
#include <vector>

#define EGL_NO_PLATFORM_SPECIFIC_TYPES  // no X11 headers
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "raster/gl/platform.hpp"
#include "raster/gl/shared_library.hpp"

namespace earthshine::raster {

namespace {

struct EglFunctions {
    SharedLibrary library{"libEGL.so.1", "libEGL.so"};
    PFNEGLGETPROCADDRESSPROC getProcAddress = library.function<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress");
    PFNEGLQUERYSTRINGPROC queryString = library.function<PFNEGLQUERYSTRINGPROC>("eglQueryString");
    PFNEGLGETERRORPROC getError = library.function<PFNEGLGETERRORPROC>("eglGetError");
    PFNEGLINITIALIZEPROC initialize = library.function<PFNEGLINITIALIZEPROC>("eglInitialize");
    PFNEGLBINDAPIPROC bindApi = library.function<PFNEGLBINDAPIPROC>("eglBindAPI");
    PFNEGLCHOOSECONFIGPROC chooseConfig = library.function<PFNEGLCHOOSECONFIGPROC>("eglChooseConfig");
    PFNEGLCREATECONTEXTPROC createContext = library.function<PFNEGLCREATECONTEXTPROC>("eglCreateContext");
    PFNEGLDESTROYCONTEXTPROC destroyContext = library.function<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext");
    PFNEGLMAKECURRENTPROC makeCurrent = library.function<PFNEGLMAKECURRENTPROC>("eglMakeCurrent");

    template <typename Function>
    Function extension(const char* name) const {
        return reinterpret_cast<Function>(getProcAddress(name));
    }

    /// The last error of EGL, as its name in the registry.
    std::string lastError() const {
        static constexpr const char* kNames[] = {
            "EGL_SUCCESS",       "EGL_NOT_INITIALIZED", "EGL_BAD_ACCESS",        "EGL_BAD_ALLOC",
            "EGL_BAD_ATTRIBUTE", "EGL_BAD_CONFIG",      "EGL_BAD_CONTEXT",       "EGL_BAD_CURRENT_SURFACE",
            "EGL_BAD_DISPLAY",   "EGL_BAD_MATCH",       "EGL_BAD_NATIVE_PIXMAP", "EGL_BAD_NATIVE_WINDOW",
            "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",     "EGL_CONTEXT_LOST"};
        const EGLint code = getError();
        const EGLint index = code - EGL_SUCCESS;
        const bool known = index >= 0 && index < EGLint(std::size(kNames));
        return fmt::format("{} (0x{:x})", known ? kNames[index] : "unknown error", unsigned(code));
    }
};

/// Opened once; throws each time if the library is not there.
const EglFunctions& egl() {
    static const EglFunctions functions;
    return functions;
}

bool hasExtension(const char* list, std::string_view name) {
    if (!list) return false;
    std::string_view rest = list;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        if (rest.substr(0, end) == name) return true;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

class EglPlatform final : public GlPlatform {
public:
    EglPlatform(EGLDisplay display, std::string name) : display_(display), name_(std::move(name)) {
        // Never terminated: EGL gives every caller the same display and does not count its users.
        if (display_ == EGL_NO_DISPLAY) throw DeviceError("eglGetPlatformDisplayEXT: " + egl().lastError());
        EGLint major = 0;
        EGLint minor = 0;
        if (!egl().initialize(display_, &major, &minor)) throw DeviceError("eglInitialize: " + egl().lastError());
        const char* extensions = egl().queryString(display_, EGL_EXTENSIONS);
        if (!hasExtension(extensions, "EGL_KHR_surfaceless_context"))
            throw DeviceError("no EGL_KHR_surfaceless_context");
        if (!egl().bindApi(EGL_OPENGL_API)) throw DeviceError("eglBindAPI(EGL_OPENGL_API): " + egl().lastError());

        const EGLint attributes[] = {
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = egl().createContext(display_, chooseConfig(extensions), EGL_NO_CONTEXT, attributes);
        if (context_ == EGL_NO_CONTEXT) throw DeviceError("eglCreateContext(OpenGL 3.3 core): " + egl().lastError());
    }
    ~EglPlatform() override { egl().destroyContext(display_, context_); }

    void bind() override {
        egl().bindApi(EGL_OPENGL_API);  // the choice belongs to the thread
        if (!egl().makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            throw DeviceError(fmt::format("{}: eglMakeCurrent: {}", name_, egl().lastError()));
    }
    void unbind() noexcept override { egl().makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    void* getProcAddress(const char* name) const override {
        return reinterpret_cast<void*>(egl().getProcAddress(name));
    }
    void* nativeContext() const override { return context_; }
    void* nativeDisplay() const override { return display_; }
    std::string name() const override { return name_; }

private:
    EGLConfig chooseConfig(const char* extensions) const {
        if (hasExtension(extensions, "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
        const EGLint attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (!egl().chooseConfig(display_, attributes, &config, 1, &count) || count == 0)
            throw DeviceError("eglChooseConfig: no configuration for OpenGL");
        return config;
    }

    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
    std::string name_;
};

PFNEGLGETPLATFORMDISPLAYEXTPROC platformDisplayFunction(const char* requiredExtension) {
    const char* extensions = egl().queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!hasExtension(extensions, requiredExtension)) throw DeviceError(fmt::format("no {}", requiredExtension));
    return egl().extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
}

struct EglDevice {
    EGLDeviceEXT handle;
    int index;
    bool isSoftware;
};

std::vector<EglDevice> listDevices() {
    const auto queryDevices = egl().extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto queryDeviceString = egl().extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    if (!queryDevices || !queryDeviceString) throw DeviceError("no EGL_EXT_device_enumeration");
    EGLint count = 0;
    if (!queryDevices(0, nullptr, &count)) throw DeviceError("eglQueryDevicesEXT: " + egl().lastError());
    std::vector<EGLDeviceEXT> handles(static_cast<std::size_t>(count));
    if (!queryDevices(count, handles.data(), &count)) throw DeviceError("eglQueryDevicesEXT: " + egl().lastError());
    std::vector<EglDevice> devices;
    for (int i = 0; i < count; ++i) {
        const EGLDeviceEXT handle = handles[std::size_t(i)];
        const char* extensions = queryDeviceString(handle, EGL_EXTENSIONS);
        devices.push_back({handle, i, hasExtension(extensions, "EGL_MESA_device_software")});
    }
    return devices;
}

}  // namespace

std::unique_ptr<GlPlatform> openEglSurfaceless() {
    const auto getPlatformDisplay = platformDisplayFunction("EGL_MESA_platform_surfaceless");
    return std::make_unique<EglPlatform>(
        getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), "egl");
}

std::unique_ptr<GlPlatform> openEglDevice(EglDevices wanted, std::optional<int> index) {
    const auto getPlatformDisplay = platformDisplayFunction("EGL_EXT_platform_device");
    std::vector<EglDevice> devices = listDevices();
    const std::size_t listed = devices.size();
    std::erase_if(devices, [&](const EglDevice& device) {
        return (index && device.index != *index) || (wanted == EglDevices::Hardware && device.isSoftware);
    });
    std::stable_partition(devices.begin(), devices.end(), [](const EglDevice& device) { return !device.isSoftware; });
    std::string errors;
    for (const EglDevice& device : devices) {
        try {
            return std::make_unique<EglPlatform>(getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device.handle, nullptr),
                                                 fmt::format("egl-device:{}", device.index));
        } catch (const DeviceError& error) {
            errors += fmt::format("{}device {}: {}", errors.empty() ? "" : ", ", device.index, error.what());
        }
    }
    if (!errors.empty()) throw DeviceError(errors);
    if (index) throw DeviceError(fmt::format("EGL lists {} device(s), none with the number {}", listed, *index));
    throw DeviceError(wanted == EglDevices::Hardware ? "EGL lists no hardware device" : "EGL lists no device");
}

}  // namespace earthshine::raster
