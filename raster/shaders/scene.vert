#version 330 core
// The vertices of every pass. All passes draw upside down (the y row of clipFromView is negated by who sets it), so
// that row 0 of a texture is the top of the picture.

#include "safe_normalize.glsl"

layout(std140) uniform InstanceBlock {
    mat4 viewFromObject;          // made in double precision: no large world coordinates here
    mat4 previousViewFromObject;  // previous camera, previous placement
    mat4 normalWsFromObject;      // 3x3, sign-true cofactors; [3][3]: -1 if the placement mirrors, else +1
    mat4 worldFromObject;         // 3x3
};
uniform mat4 clipFromView;
uniform mat4 previousClipFromView;

layout(location = 0) in vec3 positionOs;
layout(location = 1) in vec3 normalOs;
layout(location = 2) in vec4 tangentOs;
layout(location = 3) in vec2 uv0In;
layout(location = 4) in vec2 uv1In;
layout(location = 5) in vec4 colorIn;

out vec3 positionVs;
out vec3 normalWs;
out vec4 tangentWs;  // w: the sign of the bitangent
out vec2 uv0;
out vec2 uv1;
out vec4 vertexColor;
out vec3 clipXyw;
out vec3 previousClipXyw;
out float previousDepth;  // m

void main() {
    vec4 position = vec4(positionOs, 1.0);
    vec4 inView = viewFromObject * position;
    vec4 inPreviousView = previousViewFromObject * position;
    gl_Position = clipFromView * inView;

    positionVs = inView.xyz;
    normalWs = safeNormalize(mat3(normalWsFromObject) * normalOs);
    tangentWs = vec4(safeNormalize(mat3(worldFromObject) * tangentOs.xyz), tangentOs.w * normalWsFromObject[3][3]);
    uv0 = uv0In;
    uv1 = uv1In;
    vertexColor = colorIn;
    clipXyw = gl_Position.xyw;
    previousClipXyw = (previousClipFromView * inPreviousView).xyw;
    previousDepth = -inPreviousView.z;
}
