#pragma once
// Draws everything that the library needs of a frame.

#include <span>

#include "raster/gbuffer_pass.hpp"
#include "raster/rsm_pass.hpp"
#include "raster/scene_gl.hpp"
#include "raster/shadow_pass.hpp"

namespace earthshine::raster {

struct RasterSettings {
    Extent extent;               ///< px - of the G-buffer
    int rsmSizePx = 512;         ///< (px > 0) - side of each light's reflective shadow map
    int shadowSizePx = 2048;     ///< (px > 0) - side of each light's shadow map
    glm::vec3 background{0.0f};  ///< cd/m^2 - where the camera sees nothing
};

/// A scene in a context, and the passes over it. One thread at a time; the context must outlive it.
class SceneRenderer {
public:
    /// Uploads the scene, which is not needed afterwards. Throws InputError, BuildError, DeviceError.
    SceneRenderer(GlContext& context, const Scene& scene);
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    /// Moves an instance of the scene; the motion of the next frame is from where it was in the frame before. Throws
    /// UsageError if there is no such instance.
    void setWorldFromObject(int instance, const glm::mat4& worldFromObject);

    /// Draws one frame. The textures belong to the renderer and are used again by the next frame; they are made anew
    /// when an extent or the number of lights changes. Without lights the light maps have the name 0. GL may still be
    /// drawing when this returns. Throws UsageError for settings that make no sense, DeviceError if GL refuses.
    GlFrame render(const Camera& camera, const Camera& previousCamera, std::span<const Light> lights,
                   const RasterSettings& settings);

private:
    GlContext* context_;
    SceneGl scene_;
    GBufferPass gbufferPass_;
    RsmPass rsmPass_;
    ShadowPass shadowPass_;
};

}  // namespace earthshine::raster
