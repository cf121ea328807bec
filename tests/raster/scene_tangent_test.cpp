// Tangents: on quads with known uv the tangent frame is known.

#include <cmath>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include "raster/scene_support.hpp"

namespace earthshine::raster::test {
namespace {

// Tangents of the quads below are exact but for the rounding of a few sines and square roots.
constexpr float kRounding = 2e-6f;

/// The quad with a normal-mapped material and the uvs `uvFromXy` of (x, y).
template <typename Function>
GltfBuilder mappedQuad(const Function& uvFromXy) {
    GltfBuilder builder = quadBuilder();
    std::vector<float> uvs;
    const std::vector<float> positions = Quad::positions();
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::vec2 uv = uvFromXy(glm::vec2(positions[3 * i], positions[3 * i + 1]));
        uvs.insert(uvs.end(), {uv.x, uv.y});
    }
    Json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = builder.accessor(uvs, "VEC2");
    primitive["material"] = builder.add("materials", {{"normalTexture", {{"index", builder.addTexture(pngRgba8())}}}});
    return builder;
}

void expectTangents(const Scene& scene, const glm::vec3& tangent, float handedness) {
    for (const Vertex& vertex : scene.meshes.at(0).vertices) {
        EXPECT_NEAR(vertex.tangent.x, tangent.x, kRounding);
        EXPECT_NEAR(vertex.tangent.y, tangent.y, kRounding);
        EXPECT_NEAR(vertex.tangent.z, tangent.z, kRounding);
        EXPECT_EQ(vertex.tangent.w, handedness);
    }
}

TEST(SceneTangents, UprightPicture) {
    // u to the right, v down: the picture as it is seen; green (+y of the map) is up.
    const Scene scene = mappedQuad([](glm::vec2 p) { return glm::vec2(p.x, -p.y); }).load();
    expectTangents(scene, {1, 0, 0}, 1.0f);
}

TEST(SceneTangents, MirroredPicture) {
    const Scene scene = mappedQuad([](glm::vec2 p) { return glm::vec2(-p.x, -p.y); }).load();
    expectTangents(scene, {-1, 0, 0}, -1.0f);
    const Scene flipped = mappedQuad([](glm::vec2 p) { return glm::vec2(p.x, p.y); }).load();
    expectTangents(flipped, {1, 0, 0}, -1.0f);
}

TEST(SceneTangents, RotatedAndStretchedPicture) {
    // The tangent is where u grows while v does not: with u = a . p and v = b . p it is perpendicular to b.
    const float angle = 0.4f;
    const glm::vec2 along(std::cos(angle), std::sin(angle));
    const Scene scene = mappedQuad([&](glm::vec2 p) {
                            return glm::vec2(3.0f * (along.x * p.x + along.y * p.y), along.y * p.x - along.x * p.y);
                        }).load();
    expectTangents(scene, {along.x, along.y, 0}, 1.0f);
}

TEST(SceneTangents, FollowTheTextureTransform) {
    // The extension turns the coordinates counter-clockwise, so the picture and the frame of its map clockwise.
    GltfBuilder builder = mappedQuad([](glm::vec2 p) { return glm::vec2(p.x, -p.y); });
    const float angle = 0.4f;
    Json& info = builder.document["materials"][0]["normalTexture"];
    info["extensions"]["KHR_texture_transform"] = {{"rotation", angle}, {"offset", {5, 6}}, {"scale", {2, 2}}};
    // uv' = 2 R(angle) uv: u' = 2 (cos x - sin y), so u' grows along (cos, -sin).
    expectTangents(builder.load(), {std::cos(angle), -std::sin(angle), 0}, 1.0f);
    info["extensions"]["KHR_texture_transform"] = {{"scale", {-1, 1}}};
    expectTangents(builder.load(), {-1, 0, 0}, -1.0f);
}

TEST(SceneTangents, UseTheCoordinatesOfTheNormalTexture) {
    GltfBuilder builder = mappedQuad([](glm::vec2 p) { return glm::vec2(p.x, -p.y); });
    builder.document["materials"][0]["normalTexture"]["texCoord"] = 1;
    builder.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        builder.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, "VEC2");  // u downwards, v to the right
    expectTangents(builder.load(), {0, -1, 0}, -1.0f);
    // The extension's own texCoord wins over the texture's.
    builder.document["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = {{"texCoord", 0}};
    expectTangents(builder.load(), {1, 0, 0}, 1.0f);
}

TEST(SceneTangents, SplitWhereHandednessChanges) {
    // Two quads side by side, the right one mirrored in u, as in textures of symmetric things. They share an edge.
    GltfBuilder builder = mappedQuad([](glm::vec2 p) { return p; });
    Json& primitive = builder.document["meshes"][0]["primitives"][0];
    const std::vector<float> positions = {-1, 1, 0, -1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1, 0, 0};
    const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    const std::vector<float> uvs = {0, 0, 0, 1, 1, 0, 1, 1, 0, 0, 0, 1};
    primitive["attributes"] = {{"POSITION", builder.accessor(positions, "VEC3")},
                               {"NORMAL", builder.accessor(normals, "VEC3")},
                               {"TEXCOORD_0", builder.accessor(uvs, "VEC2")}};
    primitive["indices"] = builder.accessor(std::vector<std::uint8_t>{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5}, "SCALAR");
    const Scene scene = builder.load();
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.vertices.size(), 8u);  // the two vertices of the seam are there twice
    ASSERT_EQ(mesh.indices.size(), 12u);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const bool left = i < 6;
        const glm::vec4& tangent = mesh.vertices[mesh.indices[i]].tangent;
        EXPECT_NEAR(tangent.x, left ? 1.0f : -1.0f, kRounding);
        EXPECT_EQ(tangent.w, left ? 1.0f : -1.0f);
    }
}

TEST(SceneTangents, AreProjectedToThePlaneOfTheNormal) {
    // A ridge along z with one shared normal (0, 1, 0); the left slope's u runs up, the right slope's u runs down.
    // Projected to the plane of the normal both run along +x: so does their mean.
    GltfBuilder builder = mappedQuad([](glm::vec2 p) { return p; });
    Json& primitive = builder.document["meshes"][0]["primitives"][0];
    const std::vector<float> positions = {-1, 0, 1, -1, 0, -1, 0, 1, 1, 0, 1, -1, 1, 0, 1, 1, 0, -1};
    const std::vector<float> normals = {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
    const std::vector<float> uvs = {0, 1, 0, 0, 0.5f, 1, 0.5f, 0, 1, 1, 1, 0};
    primitive["attributes"] = {{"POSITION", builder.accessor(positions, "VEC3")},
                               {"NORMAL", builder.accessor(normals, "VEC3")},
                               {"TEXCOORD_0", builder.accessor(uvs, "VEC2")}};
    primitive["indices"] = builder.accessor(std::vector<std::uint8_t>{0, 2, 1, 2, 3, 1, 2, 4, 3, 4, 5, 3}, "SCALAR");
    const Scene scene = builder.load();
    EXPECT_EQ(scene.meshes.at(0).vertices.size(), 6u);
    expectTangents(scene, {1, 0, 0}, 1.0f);
}

TEST(SceneTangents, AreWeightedByTheAngleOfTheCorner) {
    // Two triangles in z = 0 whose coordinates agree on their common edge and differ in direction: u runs along (1, 0)
    // in the first and along (1, 1) in the second. Angles at (0, 0): 90 and 45 degrees; at (0, 1): 45 and 90.
    const std::vector<float> xy = {0, 0, 1, 0, 0, 1, -1, 1};
    const std::vector<float> uv = {0, 0, 1, 0, 0, -1, -1, -2};
    const std::vector<std::size_t> corners = {0, 1, 2, 0, 2, 3};
    const glm::vec2 diagonal(std::sqrt(0.5f));
    const glm::vec2 expected[] = {glm::normalize(2.0f * glm::vec2(1, 0) + diagonal), glm::vec2(1, 0),
                                  glm::normalize(glm::vec2(1, 0) + 2.0f * diagonal), diagonal};
    for (const bool indexed : {true, false}) {  // equal corners share their tangent, whether they are one vertex or two
        GltfBuilder builder = mappedQuad([](glm::vec2 p) { return p; });
        std::vector<float> positions, normals, uvs;
        for (const std::size_t i : indexed ? std::vector<std::size_t>{0, 1, 2, 3} : corners) {
            positions.insert(positions.end(), {xy[2 * i], xy[2 * i + 1], 0});
            normals.insert(normals.end(), {0, 0, 1});
            uvs.insert(uvs.end(), {uv[2 * i], uv[2 * i + 1]});
        }
        Json& primitive = builder.document["meshes"][0]["primitives"][0];
        primitive["attributes"] = {{"POSITION", builder.accessor(positions, "VEC3")},
                                   {"NORMAL", builder.accessor(normals, "VEC3")},
                                   {"TEXCOORD_0", builder.accessor(uvs, "VEC2")}};
        if (indexed) {
            primitive["indices"] = builder.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
        } else {
            primitive.erase("indices");
        }
        const Scene scene = builder.load();
        const Mesh& mesh = scene.meshes.at(0);
        ASSERT_EQ(mesh.indices.size(), corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const glm::vec4& tangent = mesh.vertices[mesh.indices[i]].tangent;
            EXPECT_NEAR(tangent.x, expected[corners[i]].x, kRounding);
            EXPECT_NEAR(tangent.y, expected[corners[i]].y, kRounding);
            EXPECT_EQ(tangent.w, 1.0f);
        }
    }
}

TEST(SceneTangents, OfTheFileAreKept) {
    GltfBuilder builder = mappedQuad([](glm::vec2 p) { return p; });
    // Not quite unit, not quite perpendicular, as exporters round: made so.
    builder.document["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        builder.accessor(std::vector<float>{0, 2, 0.1f, -1, 0, 2, 0.1f, -1, 0, 2, 0.1f, -1, 0, 2, 0.1f, -1}, "VEC4");
    expectTangents(builder.load(), {0, 1, 0}, -1.0f);
}

TEST(SceneTangents, AreUnitAndPerpendicularEvenWithoutUvArea) {
    for (const bool mapped : {true, false}) {
        GltfBuilder builder = mappedQuad([](glm::vec2) { return glm::vec2(0.5f, 0.5f); });
        const float third = 1.0f / std::sqrt(3.0f);
        const std::vector<float> normals = {0, 0, 1, 0, 0, -1, third, third, third, -1, 0, 0};
        Json& primitive = builder.document["meshes"][0]["primitives"][0];
        primitive["attributes"]["NORMAL"] = builder.accessor(normals, "VEC3");
        if (!mapped) primitive.erase("material");
        const Scene scene = builder.load();
        for (const Vertex& vertex : scene.meshes.at(0).vertices) {
            const glm::vec3 tangent(vertex.tangent);
            EXPECT_NEAR(glm::length(tangent), 1.0f, kRounding);
            EXPECT_NEAR(glm::dot(tangent, vertex.normal), 0.0f, kRounding);
            EXPECT_EQ(std::abs(vertex.tangent.w), 1.0f);
        }
    }
}

}  // namespace
}  // namespace earthshine::raster::test
