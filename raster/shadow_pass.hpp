#pragma once
// Draws the shadow map of each light: earthshine/frame.hpp, LightMaps::shadowDepth.

#include <span>

#include "raster/scene_gl.hpp"

namespace earthshine::raster {

class ShadowPass {
public:
    /// Throws BuildError.
    explicit ShadowPass(GlContext& context);

    /// Draws maps of sizePx x sizePx, one a light (at least one), below one another: R32F, 0 where nothing is. Culls as
    /// the RSM does, so that both agree on what the light sees. The texture stays valid until the number of lights or
    /// the size changes. Throws DeviceError, also for an atlas that is too high.
    GlTexture render(const SceneGl& scene, std::span<const Light> lights, int sizePx);

private:
    GlContext* context_;
    ScenePrograms programs_;
    RenderTarget target_;
};

}  // namespace earthshine::raster
