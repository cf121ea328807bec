#include "raster/scene_renderer.hpp"

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine::raster {

namespace {

/// The context as it must be for everything that follows.
GlContext& current(GlContext& context) {
    context.makeCurrent();
    return context;
}

}  // namespace

SceneRenderer::SceneRenderer(GlContext& context, const Scene& scene)
    : context_(&current(context)),
      scene_(context, scene),
      gbufferPass_(context),
      rsmPass_(context),
      shadowPass_(context) {}

SceneRenderer::~SceneRenderer() {
    context_->makeCurrent();  // the members give their GL names back
}

void SceneRenderer::setWorldFromObject(int instance, const glm::mat4& worldFromObject) {
    scene_.setWorldFromObject(instance, worldFromObject);
}

GlFrame SceneRenderer::render(const Camera& camera, const Camera& previousCamera, std::span<const Light> lights,
                              const RasterSettings& settings) {
    const Extent extent = settings.extent;
    if (extent.widthPx < 1 || extent.heightPx < 1 || settings.rsmSizePx < 1 || settings.shadowSizePx < 1)
        throw UsageError(
            fmt::format("a picture of {}x{}, RSMs of {} and shadow maps of {} texels: each must be at "
                        "least 1",
                        extent.widthPx, extent.heightPx, settings.rsmSizePx, settings.shadowSizePx));
    context_->makeCurrent();
    GlFrame frame;
    const GBufferPass::Textures gbuffer =
        gbufferPass_.render(scene_, camera, previousCamera, extent, settings.background);
    frame.albedo = gbuffer.albedo;
    frame.normalWs = gbuffer.normalWs;
    frame.depth = gbuffer.depth;
    frame.motion = gbuffer.motion;
    frame.emission = gbuffer.emission;
    frame.lightCount = int(lights.size());
    if (!lights.empty()) {
        const RsmPass::Textures rsm = rsmPass_.render(scene_, lights, settings.rsmSizePx);
        frame.rsmDepth = rsm.depth;
        frame.rsmNormalWs = rsm.normalWs;
        frame.rsmFlux = rsm.flux;
        frame.shadowDepth = shadowPass_.render(scene_, lights, settings.shadowSizePx);
    }
    scene_.endFrame();
    return frame;
}

}  // namespace earthshine::raster
