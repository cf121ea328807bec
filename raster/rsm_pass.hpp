#pragma once
// Draws the reflective shadow map of each light: earthshine/frame.hpp, LightMaps.

#include <span>

#include "raster/scene_gl.hpp"

namespace earthshine::raster {

class RsmPass {
public:
    /// Atlases: light i owns the rows [i * sizePx; (i + 1) * sizePx).
    struct Textures {
        GlTexture depth;     ///< R32F
        GlTexture normalWs;  ///< RGBA16F
        GlTexture flux;      ///< RGBA32F
    };

    /// Throws BuildError.
    explicit RsmPass(GlContext& context);

    /// Draws maps of sizePx x sizePx, one a light (at least one); where nothing is, all is 0. The textures stay valid
    /// until the number of lights or the size changes. Throws DeviceError, also for an atlas that is too high.
    Textures render(const SceneGl& scene, std::span<const Light> lights, int sizePx);

private:
    GlContext* context_;
    ScenePrograms programs_;
    RenderTarget target_;
};

}  // namespace earthshine::raster
