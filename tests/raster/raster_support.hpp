#pragma once
// Small scenes made by hand, and frames drawn and read back as 32-bit floats.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "raster/scene_renderer.hpp"

namespace earthshine::raster::test {

/// The square [-1; 1]^2 in the plane z = 0, front towards +z, uv (0, 0) at (-1, +1): the picture stands upright.
/// `cells` squares a side.
Mesh unitQuad(int material, int cells = 1);

/// The cube [-1; 1]^3, fronts outside, or inside if `inwards`.
Mesh unitBox(int material, bool inwards = false);

/// A Lambertian material of one colour.
Material diffuse(const glm::vec3& albedo);

/// One unit quad of one material, placed.
Scene quadScene(const Material& material, const glm::mat4& worldFromObject = glm::mat4(1));

/// 8-bit RGBA texels, nearest filtering, no mipmaps.
Texture nearestTexture(int widthPx, int heightPx, std::vector<std::uint8_t> rgba8);

/// A perspective camera at `position` that looks at `target`.
Camera lookAtCamera(const glm::dvec3& position, const glm::dvec3& target, Extent extent, double verticalFov = 0.9);

/// An orthographic light map camera: [-half; half]^2 around `position`, depths (0; reach].
Camera orthographicCamera(const glm::dvec3& position, const glm::dvec3& target, double halfM, double reachM);

/// A directional light along that camera.
Light directionalLight(const glm::vec3& lux, const Camera& camera);

/// A spot light with a map that just holds its cone.
Light spotLight(const glm::vec3& candela, const glm::dvec3& position, const glm::dvec3& target, float innerConeAngle,
                float outerConeAngle, double reachM);

/// A frame in host memory, all channels as floats.
struct HostFrame {
    HostImage albedo, normalWs, depth, motion, emission;
    HostImage rsmDepth, rsmNormalWs, rsmFlux, shadowDepth;
};
HostFrame readFrame(GlContext& context, const GlFrame& frame);

/// The kind of the contexts of these tests: "egl", so that a GPU changes no result, or what the environment variable
/// EARTHSHINE_TEST_GL names ("egl-device" tests a GPU's driver).
std::string testedKind();

/// Another kind of context. None if EARTHSHINE_TEST_GL is set and it cannot be had, which must be said in one line: a
/// machine with a GPU's driver need not have Mesa. Without the variable every kind is there.
std::unique_ptr<GlContext> otherContext(const char* which);

/// One context a process, of the kind under test.
GlContext& sharedContext();

/// Draws one still frame of a scene in the shared context.
HostFrame drawScene(const Scene& scene, const Camera& camera, const RasterSettings& settings,
                    const std::vector<Light>& lights = {});

glm::vec4 rgba(const HostImage& image, int x, int y);

/// The centre of pixel (x, y) in view space on the plane z = -1, from the projection alone, in double precision.
glm::dvec3 pixelRayVs(const Camera& camera, Extent extent, double x, double y);

/// How far, in px along x and along y, a driver may move a vertex onto its grid of 2^-GL_SUBPIXEL_BITS px before it
/// interpolates: half a step. What is interpolated at a pixel's centre may then be what is true that far beside it.
double subpixelShiftPx(GlContext& context);

/// The smallest and the largest value of what(x, y) where a driver may look for the centre of pixel (x, y): there, and
/// in the corners of what subpixelShiftPx() allows.
struct Range {
    double min, max;
    /// By how much a value lies outside; 0 within.
    double misses(double value) const { return std::max({min - value, value - max, 0.0}); }
};
template <class What>
Range rangeAround(int x, int y, double shiftPx, What&& what) {
    Range range{what(x + 0.5, y + 0.5), what(x + 0.5, y + 0.5)};
    for (const double toX : {-shiftPx, shiftPx})
        for (const double toY : {-shiftPx, shiftPx}) {
            const double value = what(x + 0.5 + toX, y + 0.5 + toY);
            range = {std::min(range.min, value), std::max(range.max, value)};
        }
    return range;
}

/// Where a point of the world falls in the picture, px from the top left corner, in double precision.
glm::dvec2 projectPx(const Camera& camera, Extent extent, const glm::dvec3& positionWs);

}  // namespace earthshine::raster::test
