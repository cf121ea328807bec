#include "earthshine/frame.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace earthshine {

namespace {

bool isFinite(const glm::mat4& m) {
    return std::all_of(glm::value_ptr(m), glm::value_ptr(m) + 16, [](float v) { return std::isfinite(v); });
}

bool isPerspective(const glm::mat4& clipFromView) {
    return clipFromView[2][3] != 0.0f;
}

}  // namespace

std::string faultOf(const Camera& camera) {
    if (!isFinite(camera.viewFromWorld)) return "viewFromWorld: every number must be finite";
    if (!isFinite(camera.clipFromView)) return "clipFromView: every number must be finite";
    if (glm::row(camera.viewFromWorld, 3) != glm::vec4(0, 0, 0, 1))
        return "viewFromWorld: its last row must be 0 0 0 1; numbers go column by column";
    const auto axes = glm::mat3(camera.viewFromWorld);
    const glm::mat3 shouldBeOne = glm::transpose(axes) * axes;
    for (int i = 0; i < 9; ++i)  // 1e-3: floats written with four digits still pass, a scale of 1 % does not
        if (std::fabs(shouldBeOne[i / 3][i % 3] - (i % 4 == 0 ? 1.0f : 0.0f)) > 1e-3f)
            return "viewFromWorld: must be a rotation and a translation, without scale";
    if (glm::determinant(axes) < 0.0f)
        return "viewFromWorld: mirrors the world; view space is right-handed and looks along -z";

    const glm::mat4& p = camera.clipFromView;
    if (!(std::fabs(glm::determinant(glm::dmat4(p))) > 0.0)) return "clipFromView: cannot be inverted";
    const glm::vec4 w = glm::row(p, 3);
    if (w.x != 0.0f || w.y != 0.0f || !(isPerspective(p) ? w.z < 0.0f && w.w == 0.0f : w.w > 0.0f))
        return "clipFromView: its last row must be 0 0 -1 0 (perspective) or 0 0 0 1 (orthographic), or a positive "
               "multiple";
    if (p[1][0] != 0.0f || p[0][1] != 0.0f) return "clipFromView: must not skew x and y";
    const glm::vec4 offCentre = isPerspective(p) ? p[3] : p[2];
    if (offCentre.x != 0.0f || offCentre.y != 0.0f)
        return isPerspective(p) ? "clipFromView: a perspective projection must not move x or y"
                                : "clipFromView: an orthographic projection must not shear x or y";
    if (!(p[0][0] > 0.0f && p[1][1] > 0.0f)) return "clipFromView: must not mirror x or y";
    return {};
}

std::string faultOf(const Light& light) {
    for (int i = 0; i < 3; ++i)
        if (!(light.intensity[i] >= 0.0f && std::isfinite(light.intensity[i])))
            return "intensity: must be finite and not negative";
    if (const std::string fault = faultOf(light.camera); !fault.empty()) return "camera: " + fault;
    const bool isSpot = light.type == LightType::Spot;
    if (isSpot != isPerspective(light.camera.clipFromView))
        return isSpot ? "camera: clipFromView: a spot needs a perspective projection"
                      : "camera: clipFromView: a directional light needs an orthographic projection";
    if (!(light.rangeM >= 0.0f)) return "rangeM: must not be negative; 0 is without end";
    if (!(light.indirectScale >= 0.0f && light.indirectScale <= 1000.0f)) return "indirectScale: must be in [0; 1000]";
    if (!(light.gatherRadiusUv >= 0.0f && light.gatherRadiusUv <= 2.0f))
        return "gatherRadiusUv: must be in [0; 2]; 0 is the setting's radius";
    if (isSpot && !(0.0f <= light.innerConeAngle && light.innerConeAngle < light.outerConeAngle &&
                    light.outerConeAngle < std::numbers::pi_v<float> / 2))
        return "a spot needs 0 <= innerConeAngle < outerConeAngle < pi/2, in radians";
    return {};
}

float texelPowerOnAxis(const Light& light, Extent extent) {
    // clipFromView / w maps a half extent (directional, m) or its tangent (spot) to 1 along each axis.
    const glm::mat4& p = light.camera.clipFromView;
    const float w = isPerspective(p) ? -p[2][3] : p[3][3];
    return std::fabs(4.0f * (w / p[0][0]) * (w / p[1][1]) / (float(extent.widthPx) * float(extent.heightPx)));
}

float spotAttenuation(const Light& light, float cosAngle) {
    const float cosOuter = std::cos(light.outerConeAngle);
    const float cosInner = std::cos(light.innerConeAngle);
    const float t = std::clamp((cosAngle - cosOuter) / std::max(cosInner - cosOuter, 1e-3f), 0.0f, 1.0f);
    return t * t;
}

float rangeAttenuation(const Light& light, float distanceM) {
    if (light.rangeM <= 0.0f) return 1.0f;
    const float ratio = distanceM / light.rangeM;
    return std::clamp(1.0f - ratio * ratio * ratio * ratio, 0.0f, 1.0f);
}

}  // namespace earthshine
