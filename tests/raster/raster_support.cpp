#include "raster/raster_support.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "earthshine/error.hpp"

// LeakSanitizer asks this function, if it is there: Mesa's OSMesa never frees what it allocates for its framebuffers.
extern "C" const char* __lsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
    return "leak:libOSMesa.so";
}

namespace earthshine::raster::test {

namespace {

Camera makeCamera(const glm::dmat4& clipFromView, const glm::dvec3& position, const glm::dvec3& target) {
    const glm::dvec3 forward = glm::normalize(target - position);
    const glm::dvec3 up = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    return {glm::mat4(glm::lookAt(position, target, up)), glm::mat4(clipFromView)};
}

void appendFace(Mesh& mesh, const glm::mat3& faceFromQuad, int cells) {
    const auto first = std::uint32_t(mesh.vertices.size());
    for (int row = 0; row <= cells; ++row) {
        for (int column = 0; column <= cells; ++column) {
            const glm::vec2 uv = glm::vec2(column, row) / float(cells);
            Vertex vertex;
            vertex.position = faceFromQuad * glm::vec3(2.0f * uv.x - 1.0f, 1.0f - 2.0f * uv.y, 0.0f) + faceFromQuad[2];
            vertex.normal = faceFromQuad[2];
            // Bitangent = the direction in which v falls, as glTF has it: up in the picture.
            vertex.tangent = glm::vec4(faceFromQuad[0], 1.0f);
            vertex.uv0 = uv;
            vertex.uv1 = uv;
            mesh.vertices.push_back(vertex);
        }
    }
    const auto stride = std::uint32_t(cells) + 1;
    for (std::uint32_t row = 0; row < std::uint32_t(cells); ++row) {
        for (std::uint32_t column = 0; column < std::uint32_t(cells); ++column) {
            const std::uint32_t corner = first + row * stride + column;
            for (const std::uint32_t i : {0u, stride, stride + 1, 0u, stride + 1, 1u})
                mesh.indices.push_back(corner + i);
        }
    }
}

}  // namespace

Mesh unitQuad(int material, int cells) {
    Mesh mesh;
    mesh.name = "quad";
    mesh.material = material;
    appendFace(mesh, glm::mat3(1.0f), cells);
    for (Vertex& vertex : mesh.vertices) vertex.position.z = 0.0f;
    mesh.boundsMin = {-1, -1, 0};
    mesh.boundsMax = {1, 1, 0};
    return mesh;
}

Mesh unitBox(int material, bool inwards) {
    Mesh mesh;
    mesh.name = "box";
    mesh.material = material;
    const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    for (const glm::mat3& face : {glm::mat3(x, y, z), glm::mat3(-x, y, -z), glm::mat3(-z, y, x), glm::mat3(z, y, -x),
                                  glm::mat3(x, -z, y), glm::mat3(x, z, -y)})
        appendFace(mesh, face, 1);
    if (inwards) {
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
        for (Vertex& vertex : mesh.vertices) {
            vertex.normal = -vertex.normal;
            vertex.tangent.w = -vertex.tangent.w;
        }
    }
    mesh.boundsMin = glm::vec3(-1);
    mesh.boundsMax = glm::vec3(1);
    return mesh;
}

Material diffuse(const glm::vec3& albedo) {
    Material material;
    material.baseColor = glm::vec4(albedo, 1.0f);
    material.metallic = 0.0f;
    return material;
}

Scene quadScene(const Material& material, const glm::mat4& worldFromObject) {
    Scene scene;
    scene.name = "quad.gltf";
    scene.materials = {material};
    scene.meshes = {unitQuad(0)};
    scene.instances = {{0, worldFromObject}};
    return scene;
}

Texture nearestTexture(int widthPx, int heightPx, std::vector<std::uint8_t> rgba8) {
    Texture texture;
    texture.name = "texture";
    texture.widthPx = widthPx;
    texture.heightPx = heightPx;
    texture.rgba8 = std::move(rgba8);
    texture.linearFilter = false;
    texture.mipmaps = false;
    return texture;
}

Camera lookAtCamera(const glm::dvec3& position, const glm::dvec3& target, Extent extent, double verticalFov) {
    const double aspect = double(extent.widthPx) / extent.heightPx;
    return makeCamera(glm::perspective(verticalFov, aspect, 0.1, 100.0), position, target);
}

Camera orthographicCamera(const glm::dvec3& position, const glm::dvec3& target, double halfM, double reachM) {
    return makeCamera(glm::ortho(-halfM, halfM, -halfM, halfM, 0.0, reachM), position, target);
}

Light directionalLight(const glm::vec3& lux, const Camera& camera) {
    Light light;
    light.type = LightType::Directional;
    light.intensity = lux;
    light.camera = camera;
    return light;
}

Light spotLight(const glm::vec3& candela, const glm::dvec3& position, const glm::dvec3& target, float innerConeAngle,
                float outerConeAngle, double reachM) {
    Light light;
    light.type = LightType::Spot;
    light.intensity = candela;
    light.innerConeAngle = innerConeAngle;
    light.outerConeAngle = outerConeAngle;
    light.camera =
        makeCamera(glm::perspective(2.0 * double(outerConeAngle), 1.0, 1e-3 * reachM, reachM), position, target);
    return light;
}

HostFrame readFrame(GlContext& context, const GlFrame& frame) {
    const auto read = [&](const GlTexture& texture) {
        return texture.name ? toFloat(readTexture(context, texture).view()) : HostImage();
    };
    return {read(frame.albedo),      read(frame.normalWs), read(frame.depth),
            read(frame.motion),      read(frame.emission), read(frame.rsmDepth),
            read(frame.rsmNormalWs), read(frame.rsmFlux),  read(frame.shadowDepth)};
}

std::string testedKind() {
    const char* const which = std::getenv("EARTHSHINE_TEST_GL");
    return which ? which : "egl";
}

std::unique_ptr<GlContext> otherContext(const char* which) {
    try {
        return createContext(which);
    } catch (const DeviceError& error) {
        if (!std::getenv("EARTHSHINE_TEST_GL")) throw;
        const std::string reason = error.what();
        std::printf("%s\n", reason.c_str());
        EXPECT_EQ(reason.find('\n'), std::string::npos) << "not one line";
        return nullptr;
    }
}

GlContext& sharedContext() {
    static const std::unique_ptr<GlContext> context = createContext(testedKind());
    return *context;
}

HostFrame drawScene(const Scene& scene, const Camera& camera, const RasterSettings& settings,
                    const std::vector<Light>& lights) {
    SceneRenderer renderer(sharedContext(), scene);
    return readFrame(sharedContext(), renderer.render(camera, camera, lights, settings));
}

glm::vec4 rgba(const HostImage& image, int x, int y) {
    const float* p = image.pixel(x, y);
    return {p[0], p[1], p[2], p[3]};
}

glm::dvec3 pixelRayVs(const Camera& camera, Extent extent, double x, double y) {
    const glm::dvec2 ndc(2.0 * x / extent.widthPx - 1.0, 1.0 - 2.0 * y / extent.heightPx);
    return {ndc.x / double(camera.clipFromView[0][0]), ndc.y / double(camera.clipFromView[1][1]), -1.0};
}

double subpixelShiftPx(GlContext& context) {
    GLint bits = 0;
    context.gl().GetIntegerv(GL_SUBPIXEL_BITS, &bits);
    return std::ldexp(0.5, -bits);
}

glm::dvec2 projectPx(const Camera& camera, Extent extent, const glm::dvec3& positionWs) {
    const glm::dvec4 clip =
        glm::dmat4(camera.clipFromView) * (glm::dmat4(camera.viewFromWorld) * glm::dvec4(positionWs, 1.0));
    return {(clip.x / clip.w + 1.0) * 0.5 * extent.widthPx, (1.0 - clip.y / clip.w) * 0.5 * extent.heightPx};
}

}  // namespace earthshine::raster::test
