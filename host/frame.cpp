#include "earthshine/frame.hpp"

#include <algorithm>
#include <cmath>

namespace earthshine {

float texelPowerOnAxis(const Light& light, Extent extent) {
    // clipFromView maps a half extent (directional, m) or its tangent (spot) to 1 along each axis.
    const float halfX = 1.0f / light.camera.clipFromView[0][0];
    const float halfY = 1.0f / light.camera.clipFromView[1][1];
    return std::fabs(4.0f * halfX * halfY / (float(extent.widthPx) * float(extent.heightPx)));
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
