#include "raster/rsm_pass.hpp"

#include <cmath>

namespace earthshine::raster {

namespace {
enum Output { kDepth, kNormalWs, kFlux };
constexpr PixelFormat kFormats[] = {PixelFormat::R32F, PixelFormat::RGBA16F, PixelFormat::RGBA32F};
}  // namespace

RsmPass::RsmPass(GlContext& context)
    : context_(&context), programs_(context, "rsm.frag"), target_(context.gl(), kFormats) {}

RsmPass::Textures RsmPass::render(const SceneGl& scene, std::span<const Light> lights, int sizePx) {
    target_.bindAtlas(*context_, sizePx, int(lights.size()), "rsm");
    for (const int output : {kDepth, kNormalWs, kFlux}) target_.clearColor(output, {0, 0, 0, 0});
    target_.clearDepth();
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        target_.selectAtlasEntry(int(i));
        programs_.set("clipFromView", upsideDown(light.camera.clipFromView));
        programs_.set("intensity", light.intensity);
        programs_.set("texelPowerOnAxis", texelPowerOnAxis(light, {sizePx, sizePx}));
        programs_.set("isSpot", light.type == LightType::Spot ? 1.0f : 0.0f);
        programs_.set("cosConeAngles", glm::vec2(std::cos(light.innerConeAngle), std::cos(light.outerConeAngle)));
        programs_.set("rangeM", light.rangeM);
        scene.draw(programs_, light.camera.viewFromWorld, light.camera.viewFromWorld);
    }
    context_->check("rsm");
    return {target_.texture(kDepth), target_.texture(kNormalWs), target_.texture(kFlux)};
}

}  // namespace earthshine::raster
