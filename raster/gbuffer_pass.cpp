#include "raster/gbuffer_pass.hpp"

namespace earthshine::raster {

namespace {
enum Output { kAlbedo, kNormalWs, kDepth, kMotion, kEmission };
constexpr PixelFormat kFormats[] = {PixelFormat::RGBA16F, PixelFormat::RGBA16F, PixelFormat::R32F, PixelFormat::RGBA16F,
                                    PixelFormat::RGBA16F};
}  // namespace

GBufferPass::GBufferPass(GlContext& context)
    : context_(&context), programs_(context, "gbuffer.frag"), target_(context.gl(), kFormats) {}

GBufferPass::Textures GBufferPass::render(const SceneGl& scene, const Camera& camera, const Camera& previousCamera,
                                          Extent extent, const glm::vec3& background) {
    target_.resize(*context_, extent, "gbuffer");
    target_.bind();
    for (const int output : {kAlbedo, kNormalWs, kDepth, kMotion}) target_.clearColor(output, {0, 0, 0, 0});
    target_.clearColor(kEmission, {background.x, background.y, background.z, 1.0f});
    target_.clearDepth();
    programs_.set("clipFromView", upsideDown(camera.clipFromView));
    programs_.set("previousClipFromView", upsideDown(previousCamera.clipFromView));
    programs_.set("targetSizePx", glm::vec2(extent.widthPx, extent.heightPx));
    scene.draw(programs_, camera.viewFromWorld, previousCamera.viewFromWorld);
    context_->check("gbuffer");
    return {target_.texture(kAlbedo), target_.texture(kNormalWs), target_.texture(kDepth), target_.texture(kMotion),
            target_.texture(kEmission)};
}

}  // namespace earthshine::raster
