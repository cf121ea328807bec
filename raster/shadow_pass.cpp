#include "raster/shadow_pass.hpp"

namespace earthshine::raster {

namespace {
constexpr PixelFormat kFormats[] = {PixelFormat::R32F};
}

ShadowPass::ShadowPass(GlContext& context)
    : context_(&context), programs_(context, "shadow.frag"), target_(context.gl(), kFormats) {}

GlTexture ShadowPass::render(const SceneGl& scene, std::span<const Light> lights, int sizePx) {
    target_.bindAtlas(*context_, sizePx, int(lights.size()), "shadow map");
    target_.clearColor(0, {0, 0, 0, 0});
    target_.clearDepth();
    for (std::size_t i = 0; i < lights.size(); ++i) {
        target_.selectAtlasEntry(int(i));
        programs_.set("clipFromView", upsideDown(lights[i].camera.clipFromView));
        scene.draw(programs_, lights[i].camera.viewFromWorld, lights[i].camera.viewFromWorld);
    }
    context_->check("shadow map");
    return target_.texture(0);
}

}  // namespace earthshine::raster
