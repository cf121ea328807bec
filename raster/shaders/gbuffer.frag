#version 330 core
// What the camera sees: earthshine/frame.hpp, GBuffer.
//   out outAlbedo    RGBA16F  diffuse reflectance, linear, [0; 1]
//   out outNormalWs  RGBA16F  unit, towards the side that is seen; w = 1
//   out outDepth     R32F     m along the camera's -z
//   out outMotion    RGBA16F  xy: px from here to the same point in the previous frame, y down; z: m, previous depth
//                             minus this one
//   out outEmission  RGBA16F  cd/m^2

#include "material.glsl"

uniform vec2 targetSizePx;

in vec3 positionVs;
in vec3 clipXyw;
in vec3 previousClipXyw;
in float previousDepth;

layout(location = 0) out vec4 outAlbedo;
layout(location = 1) out vec4 outNormalWs;
layout(location = 2) out float outDepth;
layout(location = 3) out vec4 outMotion;
layout(location = 4) out vec4 outEmission;

const float kLargestHalf = 65504.0;

// Both projections are interpolated alike, rather than one taken from gl_FragCoord, and subtracted before they are
// multiplied, so that what stands still has a motion of exactly 0. (The plain difference of two quotients has not where
// a compiler fuses a product with the subtraction: a GPU's did.) With p the previous and c this position,
//   p.xy / p.w - c.xy / c.w = ((p - c).xy - (p - c).w c.xy / c.w) / p.w.
// A point that was behind the camera gets a motion that leaves any picture.
vec2 motionPx() {
    if (previousClipXyw.z <= 0.0) return vec2(kLargestHalf);
    vec3 difference = previousClipXyw - clipXyw;
    vec2 ndcMotion = (difference.xy - difference.z * (clipXyw.xy / clipXyw.z)) / previousClipXyw.z;
    return clamp(ndcMotion * 0.5 * targetSizePx, -kLargestHalf, kLargestHalf);
}

void main() {
    float depth = -positionVs.z;
    vec4 color = surfaceColor();
    outAlbedo = vec4(surfaceAlbedo(color), 1.0);
    outNormalWs = vec4(surfaceNormalWs(), 1.0);
    outDepth = depth;
    outMotion = vec4(motionPx(), clamp(previousDepth - depth, -kLargestHalf, kLargestHalf), 0.0);
    outEmission = vec4(min(surfaceEmission(), kLargestHalf), 1.0);
    discardTransparent(color);
}
