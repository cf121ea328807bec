#include "raster/gl/gl_context.hpp"

#include <charconv>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "earthshine/error.hpp"
#include "earthshine/log.hpp"

namespace earthshine::raster {

namespace {

// Two GL implementations (EGL's and OSMesa's) know nothing of each other, and both skip work for a context that they
// believe to be current still: so the old one is always let go before another is bound.
thread_local GlContext* currentContext = nullptr;

const char* errorName(GLenum code) {
    switch (code) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        default:
            return "unknown error";
    }
}

void APIENTRY keepMessage(GLenum, GLenum, GLuint, GLenum, GLsizei length, const GLchar* message, const void* user) {
    auto& kept = *static_cast<std::string*>(const_cast<void*>(user));
    kept.assign(message, length < 0 ? std::string_view(message).size() : std::size_t(length));
    while (!kept.empty() && (kept.back() == '\n' || kept.back() == ' ')) kept.pop_back();
}

bool isSoftwareRenderer(std::string_view renderer) {
    for (const std::string_view name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"})
        if (renderer.find(name) != std::string_view::npos) return true;
    return false;
}

struct Candidate {
    std::string name;
    std::function<std::unique_ptr<GlPlatform>()> open;
    bool hardwareOnly = false;
};

std::vector<Candidate> candidates(std::string_view which) {
    const Candidate hardware{"egl-device (hardware)", [] { return openEglDevice(EglDevices::Hardware); }, true};
    const Candidate surfaceless{"egl", openEglSurfaceless};
    const Candidate device{"egl-device", [] { return openEglDevice(EglDevices::All); }};
    const Candidate osmesa{"osmesa", openOsmesa};
    if (which == "auto") return {hardware, surfaceless, device, osmesa};
    if (which == "egl") return {surfaceless};
    if (which == "egl-device") return {device};
    if (which == "osmesa") return {osmesa};
    constexpr std::string_view kNumbered = "egl-device:";
    if (which.starts_with(kNumbered)) {
        const std::string_view digits = which.substr(kNumbered.size());
        int index = -1;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error == std::errc() && end == digits.data() + digits.size() && index >= 0)
            return {{std::string(which), [index] { return openEglDevice(EglDevices::All, index); }}};
    }
    throw UsageError(
        fmt::format("GL context \"{}\" is not known: use auto, egl, egl-device, egl-device:N or osmesa", which));
}

}  // namespace

GlFunctions loadGlFunctions(const GlGetProcAddress& getProcAddress) {
    GlFunctions functions;
    const auto load = [&](auto& function, const char* name) {
        using Function = std::remove_reference_t<decltype(function)>;
        function = reinterpret_cast<Function>(getProcAddress(name));
        if (!function) throw DeviceError(fmt::format("OpenGL has no {}: 3.3 core is needed", name));
    };
#define EARTHSHINE_GL_LOAD(name, type) load(functions.name, "gl" #name);
    EARTHSHINE_GL_FUNCTIONS(EARTHSHINE_GL_LOAD)
#undef EARTHSHINE_GL_LOAD
    return functions;
}

GlContext::GlContext(std::unique_ptr<GlPlatform> platform) : platform_(std::move(platform)) {
    makeCurrent();
    try {
        functions_ = loadGlFunctions(getProcAddress());
        const auto text = [this](GLenum name) {
            const GLubyte* value = functions_.GetString(name);
            return std::string(value ? reinterpret_cast<const char*>(value) : "?");
        };
        description_ = {platform_->name(), text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION)};
        description_.isSoftware = isSoftwareRenderer(description_.renderer);
        functions_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &description_.maxTextureSizePx);
        int major = 0;
        int minor = 0;
        functions_.GetIntegerv(GL_MAJOR_VERSION, &major);
        functions_.GetIntegerv(GL_MINOR_VERSION, &minor);
        if (major * 10 + minor < 33)
            throw DeviceError(fmt::format("{} gives OpenGL {}.{}, 3.3 is needed", description_.renderer, major, minor));
        listenForMessages();
    } catch (...) {
        platform_->unbind();
        currentContext = nullptr;
        throw;
    }
}

GlContext::~GlContext() {
    if (currentContext == this) {
        platform_->unbind();
        currentContext = nullptr;
    }
}

void GlContext::makeCurrent() {
    if (currentContext == this) return;
    if (currentContext) currentContext->platform_->unbind();
    currentContext = nullptr;
    platform_->bind();
    currentContext = this;
}

GlGetProcAddress GlContext::getProcAddress() const {
    return [platform = platform_.get()](const char* name) { return platform->getProcAddress(name); };
}

GlContextHandle GlContext::handle() const {
    const GlPlatformKind kind = nativeDisplay() ? GlPlatformKind::Egl : GlPlatformKind::Other;  // OSMesa has none
    return {getProcAddress(), kind, nativeContext(), nativeDisplay(), description_.renderer};
}

void GlContext::listenForMessages() {
    const auto debugMessageCallback =
        reinterpret_cast<PFNGLDEBUGMESSAGECALLBACKPROC>(platform_->getProcAddress("glDebugMessageCallback"));
    const auto debugMessageControl =
        reinterpret_cast<PFNGLDEBUGMESSAGECONTROLPROC>(platform_->getProcAddress("glDebugMessageControl"));
    if (!debugMessageCallback || !debugMessageControl) return;
    functions_.Enable(GL_DEBUG_OUTPUT);
    functions_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    debugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    debugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    debugMessageCallback(keepMessage, &driverMessage_);
    functions_.GetError();  // a driver may offer the functions and refuse them: then there are no messages
}

void GlContext::check(std::string_view where) {
    const GLenum code = functions_.GetError();
    if (code == GL_NO_ERROR) return;
    constexpr int kMostErrors = 16;  // a driver may keep one error a unit; a lost context never runs out of them
    for (int i = 0; i < kMostErrors && functions_.GetError() != GL_NO_ERROR; ++i) {
    }
    const std::string message = std::exchange(driverMessage_, {});
    throw DeviceError(fmt::format("{}: {} (0x{:x}) on \"{}\"{}{}", where, errorName(code), code, description_.renderer,
                                  message.empty() ? "" : ": ", message));
}

std::unique_ptr<GlContext> createContext(std::string_view which) {
    std::string errors;
    for (const Candidate& candidate : candidates(which)) {
        try {
            auto context = std::make_unique<GlContext>(candidate.open());
            const GlDescription& is = context->description();
            if (candidate.hardwareOnly && is.isSoftware) throw DeviceError(is.renderer + " is no hardware");
            log(LogLevel::Info, fmt::format("OpenGL by {}: {}, {}", is.platform, is.renderer, is.version));
            return context;
        } catch (const DeviceError& error) {
            errors += fmt::format("{}{}: {}", errors.empty() ? "" : "; ", candidate.name, error.what());
        }
    }
    throw DeviceError(
        fmt::format("no OpenGL context: {}; try another kind, or install a driver (Debian: libegl1 with "
                    "libgl1-mesa-dri, or libosmesa6)",
                    errors));
}

}  // namespace earthshine::raster
