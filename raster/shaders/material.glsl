// What a surface is made of at this fragment: the diffuse part of glTF's metallic-roughness material.

#include "safe_normalize.glsl"

layout(std140) uniform MaterialBlock {
    vec4 baseColor;      // linear
    vec4 emission;       // cd/m^2
    float metallic;      // [0; 1]
    float normalScale;
    float alphaCutoff;   // [0; 1]
    float blockPadding;
    ivec4 texCoords;     // base colour, metallic, normal, emission: 0 or 1; -1 = no texture
    mat3 uvFromUv[4];    // in the same order
};
uniform sampler2D baseColorTexture;
uniform sampler2D metallicTexture;
uniform sampler2D normalTexture;
uniform sampler2D emissionTexture;

in vec3 normalWs;
in vec4 tangentWs;
in vec2 uv0;
in vec2 uv1;
in vec4 vertexColor;

vec2 textureUv(int slot) {
    return (uvFromUv[slot] * vec3(texCoords[slot] == 0 ? uv0 : uv1, 1.0)).xy;
}

vec4 surfaceColor() {
    vec4 color = baseColor * vertexColor;
    if (texCoords[0] >= 0) color *= texture(baseColorTexture, textureUv(0));
    return color;
}

// The diffuse reflectance: metals reflect nothing diffusely.
vec3 surfaceAlbedo(vec4 color) {
    float metalness = metallic;
    if (texCoords[1] >= 0) metalness *= texture(metallicTexture, textureUv(1)).b;
    return clamp(color.rgb * (1.0 - metalness), 0.0, 1.0);
}

// Unit, world space, normal-mapped, on the side of the surface that is seen. The frame is made orthonormal about the
// interpolated normal; the bitangent is w * cross(normal, tangent), as glTF defines it, also where the placement
// scales unevenly. On a back face the whole frame turns round, which negates the result.
vec3 surfaceNormalWs() {
    vec3 normal = safeNormalize(normalWs);
    if (texCoords[2] >= 0) {
        vec3 tangent = safeNormalize(tangentWs.xyz - normal * dot(normal, tangentWs.xyz));
        vec3 bitangent = cross(normal, tangent) * (tangentWs.w < 0.0 ? -1.0 : 1.0);
        vec3 mapped = 2.0 * texture(normalTexture, textureUv(2)).xyz - 1.0;
        mapped.xy *= normalScale;
        normal = safeNormalize(mapped.x * tangent + mapped.y * bitangent + mapped.z * normal);
    }
    return gl_FrontFacing ? normal : -normal;
}

vec3 surfaceEmission() {
    vec3 light = emission.rgb;
    if (texCoords[3] >= 0) light *= texture(emissionTexture, textureUv(3)).rgb;
    return light;
}

// Last in main(): a texture read after a discard has no derivatives in its neighbours.
void discardTransparent(vec4 color) {
#ifdef ALPHA_MASK
    if (color.a < alphaCutoff) discard;
#endif
}
