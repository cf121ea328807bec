#pragma once
// A scene as the CPU knows it, without any GL: what the loader makes, what raster draws and the path tracer traces.
// World space is glTF's: right-handed, metres, +y up. Colours are scene-linear Rec. 709 unless a texture says sRGB.

#include <cstdint>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "raster/scene/animation.hpp"

namespace earthshine::raster {

/// One vertex as GL draws it, object space. 72 bytes, no padding.
struct Vertex {
    glm::vec3 position{0.0f};
    glm::vec3 normal{0.0f, 0.0f, 1.0f};         ///< unit
    glm::vec4 tangent{1.0f, 0.0f, 0.0f, 1.0f};  ///< unit; w = +1 or -1, bitangent = w * cross(normal, tangent)
    glm::vec2 uv0{0.0f};
    glm::vec2 uv1{0.0f};
    glm::vec4 color{1.0f};  ///< COLOR_0, linear; multiplies the base colour
};
static_assert(sizeof(Vertex) == 72);

/// Triangles of one material; three indices a triangle, counter-clockwise seen from the front.
struct Mesh {
    std::string name;
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    int material = 0;  ///< into Scene::materials; always valid
    glm::vec3 boundsMin{0.0f};
    glm::vec3 boundsMax{0.0f};
};

/// One placement of a mesh in the world.
struct Instance {
    int mesh = 0;
    glm::mat4 worldFromObject{1.0f};
    int node = -1;  ///< into Scene::nodes; -1 = it has none, and stands still
};

enum class Wrap { Repeat, MirroredRepeat, ClampToEdge };

/// Texels in host memory, row 0 first as in the file (uv (0, 0) is the top left corner of the picture), RGBA.
struct Texture {
    std::string name;
    int widthPx = 0;
    int heightPx = 0;
    bool isSrgb = false;              ///< rgb are sRGB-encoded (alpha never is)
    std::vector<std::uint8_t> rgba8;  ///< 8 bits a channel; empty if rgba16 holds the texels
    std::vector<std::uint16_t> rgba16;
    Wrap wrapU = Wrap::Repeat;
    Wrap wrapV = Wrap::Repeat;
    bool linearFilter = true;  ///< magnification; false = nearest
    bool mipmaps = true;       ///< minification uses mipmaps
};

/// A texture and where a material reads it: uv = uvFromUv * (uvN, 1) with N = texCoord (KHR_texture_transform folded
/// in).
struct TextureRef {
    int texture = -1;  ///< into Scene::textures; -1 = none
    int texCoord = 0;  ///< 0 or 1
    glm::mat3 uvFromUv{1.0f};
};

enum class AlphaMode { Opaque, Mask };

struct Material {
    std::string name;
    glm::vec4 baseColor{1.0f};
    TextureRef baseColorTexture;  ///< sRGB
    float metallic = 1.0f;
    TextureRef metallicTexture;  ///< linear, blue channel
    TextureRef normalTexture;    ///< linear
    float normalScale = 1.0f;
    glm::vec3 emission{0.0f};    ///< cd/m^2: factor x KHR_materials_emissive_strength
    TextureRef emissionTexture;  ///< sRGB
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
};

/// A camera that the file defines, placed in the world.
struct SceneCamera {
    std::string name;
    glm::mat4 worldFromView{1.0f};  ///< rigid; the camera looks along -z
    bool perspective = true;
    float verticalFov = 0.8f;  ///< (rad) perspective
    float halfHeightM = 1.0f;  ///< (m) orthographic
    float aspect = 0.0f;       ///< width / height that the file asks for; 0 = none
    float nearM = 0.1f;
    float farM = 0.0f;  ///< 0 = infinite
    int node = -1;      ///< into Scene::nodes; -1 = it has none, and stands still
};

enum class SceneLightType { Directional, Point, Spot };

/// KHR_lights_punctual, placed in the world. Shines along -z of worldFromLight (rigid).
struct SceneLight {
    std::string name;
    SceneLightType type = SceneLightType::Directional;
    glm::vec3 intensity{1.0f};  ///< colour x intensity: lux (directional) or candela
    float innerConeAngle = 0.0f;
    float outerConeAngle = 0.7853982f;
    float rangeM = 0.0f;  ///< 0 = without end
    glm::mat4 worldFromLight{1.0f};
    int node = -1;  ///< into Scene::nodes; -1 = it has none, and stands still
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Material> materials;  ///< at least one
    std::vector<Texture> textures;
    std::vector<SceneCamera> cameras;
    std::vector<SceneLight> lights;
    std::vector<SceneNode> nodes;  ///< as the file places them, parents before their children
    std::vector<Animation> animations;
    glm::vec3 boundsMin{0.0f};  ///< world space, of all instances as the file places them
    glm::vec3 boundsMax{0.0f};
    std::vector<std::string> notes;  ///< one line for each thing in the file that is not drawn as it asks

    std::size_t triangleCount() const;  ///< over all instances
};

/// Fills in the bounds of every mesh, from its vertices, and of the scene: the box around the corners of every
/// instance's box. A scene without instances gets a box of no size at the origin.
void computeBounds(Scene& scene);

}  // namespace earthshine::raster
