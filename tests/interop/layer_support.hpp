#pragma once
// What the layers of these tests have in common: GL's functions, a log, failures on demand.

#define CL_TARGET_OPENCL_VERSION 300
#define CL_USE_DEPRECATED_OPENCL_1_1_APIS
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#define EGL_NO_PLATFORM_SPECIFIC_TYPES
#include <CL/cl.h>
#include <CL/cl_ext.h>
#include <CL/cl_gl.h>
#include <CL/cl_layer.h>
#include <EGL/egl.h>
#include <GL/glcorearb.h>
#include <dlfcn.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace layer_support {

/// What the layer needs of GL. The program opens libEGL itself and keeps it local.
struct Gl {
    void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    EGLContext (*getCurrentContext)() = egl<EGLContext (*)()>("eglGetCurrentContext");
    EGLDisplay (*getCurrentDisplay)() = egl<EGLDisplay (*)()>("eglGetCurrentDisplay");
    void* (*getProcAddress)(const char*) = egl<void* (*)(const char*)>("eglGetProcAddress");
    PFNGLGETINTEGERVPROC getIntegerv = gl<PFNGLGETINTEGERVPROC>("glGetIntegerv");
    PFNGLBINDTEXTUREPROC bindTexture = gl<PFNGLBINDTEXTUREPROC>("glBindTexture");
    PFNGLBINDBUFFERPROC bindBuffer = gl<PFNGLBINDBUFFERPROC>("glBindBuffer");
    PFNGLGETTEXIMAGEPROC getTexImage = gl<PFNGLGETTEXIMAGEPROC>("glGetTexImage");
    PFNGLTEXSUBIMAGE2DPROC texSubImage2D = gl<PFNGLTEXSUBIMAGE2DPROC>("glTexSubImage2D");
    PFNGLGETTEXLEVELPARAMETERIVPROC getTexLevelParameteriv =
        gl<PFNGLGETTEXLEVELPARAMETERIVPROC>("glGetTexLevelParameteriv");
    PFNGLTEXPARAMETERFVPROC texParameterfv = gl<PFNGLTEXPARAMETERFVPROC>("glTexParameterfv");
    PFNGLGETTEXPARAMETERFVPROC getTexParameterfv = gl<PFNGLGETTEXPARAMETERFVPROC>("glGetTexParameterfv");
    PFNGLISTEXTUREPROC isTexture = gl<PFNGLISTEXTUREPROC>("glIsTexture");
    PFNGLCLIENTWAITSYNCPROC clientWaitSync = gl<PFNGLCLIENTWAITSYNCPROC>("glClientWaitSync");

private:
    template <class Function>
    Function egl(const char* name) const {
        return reinterpret_cast<Function>(dlsym(library, name));
    }
    template <class Function>
    Function gl(const char* name) const {
        return reinterpret_cast<Function>(getProcAddress(name));
    }
};
inline const Gl& gl() {
    static const Gl functions;
    return functions;
}

inline std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

inline void note(const std::string& line) {
    const std::string path = environment("EARTHSHINE_LAYER_LOG");
    std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), "a");
    if (!file) return;
    std::fprintf(file, "%s\n", line.c_str());
    std::fclose(file);
}

inline cl_int violation(const std::string& rule) {
    note("violation: " + rule);
    return CL_INVALID_OPERATION;
}

/// Is this the call that the test wants to fail? "CALL:N" or "CALL:N#ID"; counts begin anew with every new value.
inline bool fails(const char* call) {
    static std::map<std::string, int> callCounts;
    static std::string counted;
    const std::string wanted = environment("EARTHSHINE_LAYER_FAIL");
    if (std::exchange(counted, wanted) != wanted) callCounts.clear();
    return wanted.substr(0, wanted.find('#')) == std::string(call) + ":" + std::to_string(++callCounts[call]);
}

/// Pixels of the bound texture go to and from plain rows; what was bound is bound again at the end.
class Bound {
public:
    explicit Bound(GLuint texture) {
        gl().getIntegerv(GL_TEXTURE_BINDING_2D, &texture_);
        gl().getIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &pack_);
        gl().getIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack_);
        gl().bindTexture(GL_TEXTURE_2D, texture);
        gl().bindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        gl().bindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    }
    ~Bound() {
        gl().bindTexture(GL_TEXTURE_2D, GLuint(texture_));
        gl().bindBuffer(GL_PIXEL_PACK_BUFFER, GLuint(pack_));
        gl().bindBuffer(GL_PIXEL_UNPACK_BUFFER, GLuint(unpack_));
    }
    Bound(const Bound&) = delete;
    Bound& operator=(const Bound&) = delete;

private:
    GLint texture_ = 0, pack_ = 0, unpack_ = 0;
};

/// Its device's extensions, and more; not those that start with one of `hidden`.
inline cl_int extensionsWith(const cl_icd_dispatch& target, const std::string& more,
                             std::initializer_list<std::string_view> hidden, cl_device_id device, std::size_t size,
                             void* value, std::size_t* sizeOut) {
    std::size_t bytes = 0;
    if (const cl_int code = target.clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, 0, nullptr, &bytes);
        code != CL_SUCCESS)
        return code;
    std::string theirs(bytes, '\0'), text;
    target.clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, bytes, theirs.data(), nullptr);
    std::istringstream words(theirs.c_str());
    for (std::string word; words >> word;)
        if (std::ranges::none_of(hidden, [&](std::string_view h) { return word.starts_with(h); })) text += word + " ";
    text += more;
    if (sizeOut) *sizeOut = text.size() + 1;
    if (value && size < text.size() + 1) return CL_INVALID_VALUE;
    if (value) std::memcpy(value, text.c_str(), text.size() + 1);
    return CL_SUCCESS;
}

/// clGetLayerInfo of a layer of this name.
inline cl_int layerInfo(const char* layerName, cl_layer_info name, std::size_t size, void* value,
                        std::size_t* sizeOut) {
    const cl_layer_api_version version = CL_LAYER_API_VERSION_100;
    if (name != CL_LAYER_API_VERSION && name != CL_LAYER_NAME) return CL_INVALID_VALUE;
    const void* from = name == CL_LAYER_API_VERSION ? static_cast<const void*>(&version) : layerName;
    const std::size_t bytes = name == CL_LAYER_API_VERSION ? sizeof version : std::strlen(layerName) + 1;
    if (sizeOut) *sizeOut = bytes;
    if (value && size < bytes) return CL_INVALID_VALUE;
    if (value) std::memcpy(value, from, bytes);
    return CL_SUCCESS;
}

}  // namespace layer_support
