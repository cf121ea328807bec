#pragma once
// Draws what the camera sees: earthshine/frame.hpp, GBuffer.

#include "raster/scene_gl.hpp"

namespace earthshine::raster {

class GBufferPass {
public:
    struct Textures {
        GlTexture albedo;    ///< RGBA16F
        GlTexture normalWs;  ///< RGBA16F
        GlTexture depth;     ///< R32F
        GlTexture motion;    ///< RGBA16F
        GlTexture emission;  ///< RGBA16F
    };

    /// Throws BuildError.
    explicit GBufferPass(GlContext& context);

    /// Draws the scene; where nothing is, all is 0 except emission, which is `background` (cd/m^2). The textures stay
    /// valid until the extent changes. Throws DeviceError.
    Textures render(const SceneGl& scene, const Camera& camera, const Camera& previousCamera, Extent extent,
                    const glm::vec3& background);

private:
    GlContext* context_;
    ScenePrograms programs_;
    RenderTarget target_;
};

}  // namespace earthshine::raster
