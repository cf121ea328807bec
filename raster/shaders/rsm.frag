#version 330 core
// A reflective shadow map: what a light sees, and the power that each texel reflects (Dachsbacher and Stamminger 2005,
// "Reflective Shadow Maps"): earthshine/frame.hpp, LightMaps.
//   out outDepth     R32F     m along the light's -z
//   out outNormalWs  RGBA16F  unit, towards the light's side of the surface; w = 1
//   out outFlux      RGBA32F  lm: albedo x the power that the light sends through the texel
//
// The flux has no cosine of the surface: the power through a texel arrives, however the surface is tilted, since a
// tilted surface is larger within the texel by just that cosine. For the same reason it stays where the mapped normal
// points away from the light: a normal map shapes where the light goes, not how much of it arrived. Masking it there
// would take energy from bumpy surfaces at grazing angles.

#include "material.glsl"

uniform vec3 intensity;          // directional: lux across the beam; spot: cd
uniform float texelPowerOnAxis;  // directional: m^2; spot: sr
uniform float isSpot;            // 1 or 0
uniform vec2 cosConeAngles;      // spot: inner, outer
uniform float rangeM;            // spot: 0 = without end

in vec3 positionVs;

layout(location = 0) out float outDepth;
layout(location = 1) out vec4 outNormalWs;
layout(location = 2) out vec4 outFlux;

// The same formulas as spotAttenuation and rangeAttenuation of earthshine/frame.hpp (KHR_lights_punctual).
float spotAttenuation(float cosAngle) {
    float inner = cosConeAngles.x;
    float outer = cosConeAngles.y;
    float t = clamp((cosAngle - outer) / max(inner - outer, 1e-3), 0.0, 1.0);
    return t * t;
}

float rangeAttenuation(float distanceM) {
    if (rangeM <= 0.0) return 1.0;
    float ratio = distanceM / rangeM;
    return clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
}

void main() {
    vec4 color = surfaceColor();
    float texelPower = texelPowerOnAxis;
    if (isSpot > 0.5) {
        float distanceM = length(positionVs);
        float cosAngle = -positionVs.z / distanceM;
        // A texel's solid angle: cos / distance^2 of a texel on the plane z = -1.
        texelPower *= cosAngle * cosAngle * cosAngle * spotAttenuation(cosAngle) * rangeAttenuation(distanceM);
    }
    outDepth = -positionVs.z;
    outNormalWs = vec4(surfaceNormalWs(), 1.0);
    outFlux = vec4(surfaceAlbedo(color) * intensity * texelPower, 1.0);
    discardTransparent(color);
}
