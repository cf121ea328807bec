// OSMesa contexts. The few declarations of GL/osmesa.h that are used stand here, so that building needs no Mesa.

#include <array>

#include "raster/gl/gl_functions.hpp"
#include "raster/gl/platform.hpp"
#include "raster/gl/shared_library.hpp"

namespace earthshine::raster {

namespace {

using OsmesaContext = void*;
constexpr int kOsmesaFormat = 0x22;
constexpr int kOsmesaProfile = 0x33;
constexpr int kOsmesaCoreProfile = 0x34;
constexpr int kOsmesaContextMajorVersion = 0x36;
constexpr int kOsmesaContextMinorVersion = 0x37;

class OsmesaPlatform final : public GlPlatform {
public:
    OsmesaPlatform()
        : library_({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}),
          createContextAttribs_(
              library_.function<OsmesaContext (*)(const int*, OsmesaContext)>("OSMesaCreateContextAttribs")),
          destroyContext_(library_.function<void (*)(OsmesaContext)>("OSMesaDestroyContext")),
          makeCurrent_(
              library_.function<GLboolean (*)(OsmesaContext, void*, GLenum, GLsizei, GLsizei)>("OSMesaMakeCurrent")),
          getProcAddress_(library_.function<void* (*)(const char*)>("OSMesaGetProcAddress")) {
        const int attributes[] = {kOsmesaFormat,
                                  GL_RGBA,
                                  kOsmesaProfile,
                                  kOsmesaCoreProfile,
                                  kOsmesaContextMajorVersion,
                                  3,
                                  kOsmesaContextMinorVersion,
                                  3,
                                  0};
        context_ = createContextAttribs_(attributes, nullptr);
        if (!context_) throw DeviceError("OSMesaCreateContextAttribs refused an OpenGL 3.3 core context");
    }
    ~OsmesaPlatform() override { destroyContext_(context_); }

    void bind() override {
        // The default framebuffer must exist although nothing is ever drawn into it.
        if (!makeCurrent_(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1))
            throw DeviceError("osmesa: OSMesaMakeCurrent failed");
    }
    void unbind() noexcept override { makeCurrent_(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
    void* getProcAddress(const char* name) const override { return getProcAddress_(name); }
    void* nativeContext() const override { return context_; }
    void* nativeDisplay() const override { return nullptr; }
    std::string name() const override { return "osmesa"; }

private:
    SharedLibrary library_;
    OsmesaContext (*createContextAttribs_)(const int*, OsmesaContext);
    void (*destroyContext_)(OsmesaContext);
    GLboolean (*makeCurrent_)(OsmesaContext, void*, GLenum, GLsizei, GLsizei);
    void* (*getProcAddress_)(const char*);
    OsmesaContext context_ = nullptr;
    std::array<unsigned char, 4> pixel_{};
};

}  // namespace

std::unique_ptr<GlPlatform> openOsmesa() {
    return std::make_unique<OsmesaPlatform>();
}

}  // namespace earthshine::raster
