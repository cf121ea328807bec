#version 330 core
// How far a light reaches: earthshine/frame.hpp, LightMaps::shadowDepth.
//   out outDepth  R32F  m along the light's -z

#include "material.glsl"

in vec3 positionVs;

layout(location = 0) out float outDepth;

void main() {
    outDepth = -positionVs.z;
    discardTransparent(surfaceColor());
}
