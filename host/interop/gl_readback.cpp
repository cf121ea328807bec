// Transport `host`, the OpenGL half: textures into memory that OpenCL uses in place.

#include <fmt/format.h>

#include "earthshine/error.hpp"
#include "earthshine/pipeline.hpp"
#include "interop/gl_api.hpp"

namespace earthshine {

namespace {

HostImage read(const GlApi& api, const char* what, const GlTexture& texture) {
    if (texture.name == 0) return {};
    HostImage image(texture.format, texture.extent);
    api.forgetErrors();
    int width = 0, height = 0;
    bool isOfExtent = false;
    {
        const GlPixelState state(api);
        api.BindTexture(gl::kTexture2d, texture.name);
        api.GetTexLevelParameteriv(gl::kTexture2d, 0, gl::kTextureWidth, &width);
        api.GetTexLevelParameteriv(gl::kTexture2d, 0, gl::kTextureHeight, &height);
        isOfExtent = Extent{width, height} == texture.extent;
        const GlPixels pixels = glPixels(texture.format);
        if (isOfExtent) api.GetTexImage(gl::kTexture2d, 0, pixels.format, pixels.type, image.data());
    }
    api.check(fmt::format("reading back {}", what));
    if (!isOfExtent)
        throw DeviceError(fmt::format("reading back {}: the texture is {} x {}, not {} x {}", what, width, height,
                                      texture.extent.widthPx, texture.extent.heightPx));
    return image;
}

}  // namespace

FrameImages readBack(const GlFrame& frame, const Camera& camera, const std::vector<Light>& lights,
                     const GlGetProcAddress& getProcAddress) {
    if (std::size_t(frame.lightCount) != lights.size())
        throw UsageError(fmt::format("reading back: the frame has maps of {} lights, {} were given", frame.lightCount,
                                     lights.size()));
    const GlApi api("reading back", getProcAddress);
    FrameImages images;
    images.camera = camera;
    images.lights = lights;
    images.albedo = read(api, "albedo", frame.albedo);
    images.normalWs = read(api, "normal", frame.normalWs);
    images.depth = read(api, "depth", frame.depth);
    images.motion = read(api, "motion", frame.motion);
    images.emission = read(api, "emission", frame.emission);
    if (!lights.empty()) {
        images.rsmDepth = read(api, "RSM depth", frame.rsmDepth);
        images.rsmNormalWs = read(api, "RSM normal", frame.rsmNormalWs);
        images.rsmFlux = read(api, "RSM flux", frame.rsmFlux);
        images.shadowDepth = read(api, "shadow depth", frame.shadowDepth);
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
