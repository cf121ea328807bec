// Transport `host`, the OpenGL half: textures into memory that OpenCL uses in place.

#include <fmt/format.h>

#include <type_traits>

#include "earthshine/error.hpp"
#include "earthshine/pipeline.hpp"

namespace earthshine {

namespace {

// The few constants and functions of OpenGL 1.1 to 3.0 that a read-back needs; the library links no GL.
constexpr unsigned kTexture2d = 0x0DE1, kTextureBinding2d = 0x8069, kTextureWidth = 0x1000, kTextureHeight = 0x1001;
constexpr unsigned kPixelPackBuffer = 0x88EB, kPixelPackBufferBinding = 0x88ED;
constexpr unsigned kPackRowLength = 0x0D02, kPackSkipRows = 0x0D03, kPackSkipPixels = 0x0D04, kPackAlignment = 0x0D05;
constexpr unsigned kRed = 0x1903, kRgba = 0x1908, kFloat = 0x1406, kHalfFloat = 0x140B, kUnsignedByte = 0x1401;

struct GlReadback {
    void (*getIntegerv)(unsigned, int*);
    void (*bindTexture)(unsigned, unsigned);
    void (*bindBuffer)(unsigned, unsigned);
    void (*pixelStorei)(unsigned, int);
    void (*getTexImage)(unsigned, int, unsigned, unsigned, void*);
    void (*getTexLevelParameteriv)(unsigned, int, unsigned, int*);
    unsigned (*getError)();

    explicit GlReadback(const GlGetProcAddress& find) {
        const auto load = [&](auto& function, const char* name) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(find(name));
            if (!function) throw DeviceError(fmt::format("reading back: this OpenGL has no {}", name));
        };
        load(getIntegerv, "glGetIntegerv");
        load(bindTexture, "glBindTexture");
        load(bindBuffer, "glBindBuffer");
        load(pixelStorei, "glPixelStorei");
        load(getTexImage, "glGetTexImage");
        load(getTexLevelParameteriv, "glGetTexLevelParameteriv");
        load(getError, "glGetError");
    }

    int integer(unsigned name) const {
        int value = 0;
        getIntegerv(name, &value);
        return value;
    }

    HostImage read(const char* what, const GlTexture& texture) const {
        if (texture.name == 0) return {};
        HostImage image(texture.format, texture.extent);
        const unsigned format = texture.format == PixelFormat::R32F ? kRed : kRgba;
        const unsigned type = texture.format == PixelFormat::RGBA16F ? kHalfFloat
                              : texture.format == PixelFormat::RGBA8 ? kUnsignedByte
                                                                     : kFloat;
        while (getError() != 0) {
        }  // what the application left behind is not ours

        const int boundTexture = integer(kTextureBinding2d), boundBuffer = integer(kPixelPackBufferBinding);
        constexpr unsigned kPacking[] = {kPackRowLength, kPackSkipRows, kPackSkipPixels, kPackAlignment};
        int packing[4], width = 0, height = 0;
        for (int i = 0; i < 4; ++i) packing[i] = integer(kPacking[i]);
        bindTexture(kTexture2d, texture.name);
        bindBuffer(kPixelPackBuffer, 0);
        for (int i = 0; i < 4; ++i) pixelStorei(kPacking[i], kPacking[i] == kPackAlignment ? 4 : 0);
        getTexLevelParameteriv(kTexture2d, 0, kTextureWidth, &width);
        getTexLevelParameteriv(kTexture2d, 0, kTextureHeight, &height);
        const bool isOfExtent = Extent{width, height} == texture.extent;
        if (isOfExtent) getTexImage(kTexture2d, 0, format, type, image.data());
        const unsigned error = getError();

        for (int i = 0; i < 4; ++i) pixelStorei(kPacking[i], packing[i]);
        bindBuffer(kPixelPackBuffer, unsigned(boundBuffer));
        bindTexture(kTexture2d, unsigned(boundTexture));
        if (error != 0) throw DeviceError(fmt::format("reading back {}: OpenGL error 0x{:04x}", what, error));
        if (!isOfExtent)
            throw DeviceError(fmt::format("reading back {}: the texture is {} x {}, not {} x {}", what, width, height,
                                          texture.extent.widthPx, texture.extent.heightPx));
        return image;
    }
};

}  // namespace

FrameImages readBack(const GlFrame& frame, const Camera& camera, const std::vector<Light>& lights,
                     const GlGetProcAddress& getProcAddress) {
    if (std::size_t(frame.lightCount) != lights.size())
        throw UsageError(fmt::format("reading back: the frame has maps of {} lights, {} were given", frame.lightCount,
                                     lights.size()));
    const GlReadback gl(getProcAddress);
    FrameImages images;
    images.camera = camera;
    images.lights = lights;
    images.albedo = gl.read("albedo", frame.albedo);
    images.normalWs = gl.read("normal", frame.normalWs);
    images.depth = gl.read("depth", frame.depth);
    images.motion = gl.read("motion", frame.motion);
    images.emission = gl.read("emission", frame.emission);
    if (!lights.empty()) {
        images.rsmDepth = gl.read("RSM depth", frame.rsmDepth);
        images.rsmNormalWs = gl.read("RSM normal", frame.rsmNormalWs);
        images.rsmFlux = gl.read("RSM flux", frame.rsmFlux);
        images.shadowDepth = gl.read("shadow depth", frame.shadowDepth);
    }
    return images;
}

FrameInputs FrameImages::inputs() const {
    FrameInputs frame;
    frame.camera = camera;
    frame.gbuffer = {albedo.view(), normalWs.view(), depth.view(), motion.view(), emission.view()};
    frame.lights = lights;
    const int count = int(lights.size());
    const auto mapOf = [&](const HostImage& atlas, int light) {
        const int rows = atlas.extent().heightPx / count;
        return atlas.rows(light * rows, rows);
    };
    for (int i = 0; i < count; ++i)
        frame.lightMaps.push_back(
            {mapOf(rsmDepth, i), mapOf(rsmNormalWs, i), mapOf(rsmFlux, i), mapOf(shadowDepth, i)});
    return frame;
}

}  // namespace earthshine
