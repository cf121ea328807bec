#pragma once
// What one frame of a renderer is made of: the input contract of the library.
//
// Spaces.  World: right-handed, metres, any "up". View: right-handed, the camera looks along -z, y is up.
//          Clip: OpenGL's, NDC x right, y up, z in [-1; 1]. Uv: u right, v DOWN, (0, 0) is the top left corner, so
//          u = (x_ndc + 1) / 2, v = (1 - y_ndc) / 2. Pixels: (0, 0) is the top left pixel, its centre at uv (0.5 /
//          size).
// Colour.  Scene-linear, Rec. 709 primaries. Photometric units as in KHR_lights_punctual (lux, candela, so flux in
//          lumens, irradiance in lux, radiance in cd/m^2); any other consistent unit works, as everything is linear.
// Matrices are named output-from-input and multiply column vectors.

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "earthshine/image.hpp"

namespace earthshine {

/// Where something looks from (rigid motion, no scale) and how it projects (perspective or orthographic).
struct Camera {
    glm::mat4 viewFromWorld{1.0f};
    glm::mat4 clipFromView{1.0f};
};

enum class LightType { Directional, Spot };

/// A light and the camera of its shadow map and reflective shadow map (RSM). The light shines along that camera's -z;
/// a spot stands at its origin. The light's projection must cover what the light should reach: beyond it is dark for
/// indirect light, and lit without shadow for direct light.
struct Light {
    std::string name;
    LightType type = LightType::Directional;
    glm::vec3 intensity{0.0f};      ///< >= 0 - directional: illuminance across the beam, lux; spot: candela
    float innerConeAngle = 0.0f;    ///< (rad) [0; outerConeAngle) - spot: full intensity up to here from the axis
    float outerConeAngle = 0.785f;  ///< (rad) (0; pi/2) - spot: no light from here on
    float rangeM = 0.0f;            ///< (m >= 0) - spot: KHR_lights_punctual range; 0 = without end
    Camera camera;
    float indirectScale = 1.0f;   ///< [0; 1000] - times this light's indirect light; only 1 is physical
    float gatherRadiusUv = 0.0f;  ///< [0; 2] (of the RSM's side) - disk: this light's radius; 0 = the setting's
};

/// What the camera sees, one texel a pixel; all five of one extent. Sky: depth 0 and normal w 0.
struct GBuffer {
    ImageView albedo;    ///< RGBA16F - diffuse reflectance [0; 1], linear; alpha unused
    ImageView normalWs;  ///< RGBA16F - unit, world space, towards the camera's side of the surface; w = 1, or 0 on sky
    ImageView depth;     ///< R32F    - m along the camera's -z, > 0; 0 on sky
    ImageView motion;    ///< RGBA16F - xy: pixels from here to the same point in the previous frame; z: m, previous
                         ///            depth minus this depth; may be empty (nothing moved)
    ImageView emission;  ///< RGBA16F - cd/m^2 added to the picture; on sky the background; may be empty (none)
};

/// What one light sees, one texel a pixel of its projection. All lights of a frame share the extents.
struct LightMaps {
    ImageView rsmDepth;     ///< R32F    - m along the light's -z, > 0; 0 where the light meets nothing
    ImageView rsmNormalWs;  ///< RGBA16F - unit, world space; w = 1, or 0 where the light meets nothing
    ImageView rsmFlux;      ///< RGBA32F - lm: albedo x power sent through the texel (texelPowerOnAxis); alpha unused
    ImageView shadowDepth;  ///< R32F    - as rsmDepth, of any square or oblong extent of its own
};

/// One frame, borrowed from its renderer. `lights` and `lightMaps` are parallel.
struct FrameInputs {
    Camera camera;
    GBuffer gbuffer;
    std::vector<Light> lights;
    std::vector<LightMaps> lightMaps;
};

/// What is wrong with a camera or light, one line, or "" if it is as this file says: finite numbers, a rigid view, a
/// projection that is plainly perspective (w = -c z) or orthographic (w = c), off-centre or not, without skew; a
/// light's own projection, cone and intensity. Lengths of axes may be off by 1e-3, as of floats written with four
/// digits.
std::string faultOf(const Camera& camera);
std::string faultOf(const Light& light);

/// Power (lm a unit of `intensity`) that the light sends through each texel of a map of `extent` at the map's centre:
/// directional: the texel's area across the beam, m^2; spot: its solid angle on the axis, sr, so that a texel at the
/// angle theta from the axis gets cos^3(theta) of it, times spotAttenuation and rangeAttenuation.
float texelPowerOnAxis(const Light& light, Extent extent);

/// The cone's falloff of KHR_lights_punctual at the angle whose cosine is given, [0; 1].
float spotAttenuation(const Light& light, float cosAngle);

/// The range window of KHR_lights_punctual at a distance, [0; 1]; 1 if the light has no range.
float rangeAttenuation(const Light& light, float distanceM);

}  // namespace earthshine
