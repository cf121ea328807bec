// Meshes: every way to store the same triangles gives the same triangles.

#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "raster/scene_support.hpp"

namespace earthshine::raster::test {
namespace {

using Triangle = std::array<Vertex, 3>;

std::vector<Triangle> trianglesOf(const Mesh& mesh) {
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        triangles.push_back(
            {mesh.vertices[mesh.indices[i]], mesh.vertices[mesh.indices[i + 1]], mesh.vertices[mesh.indices[i + 2]]});
    }
    return triangles;
}

void expectNear(const glm::vec3& a, const glm::vec3& b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

/// The one mesh of `scene` shows the triangles of quadBuilder(), corner by corner.
void expectQuad(const Scene& scene, float tolerance = 0.0f) {
    ASSERT_EQ(scene.meshes.size(), 1u);
    const std::vector<Triangle> triangles = trianglesOf(scene.meshes[0]);
    const std::vector<std::uint32_t> corners = Quad::indices<std::uint32_t>();
    const std::vector<float> positions = Quad::positions(), uvs = Quad::uvs();
    ASSERT_EQ(triangles.size(), 2u);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vertex& vertex = triangles[i / 3][i % 3];
        const float* position = &positions[3 * corners[i]];
        expectNear(vertex.position, {position[0], position[1], position[2]}, tolerance);
        expectNear(vertex.normal, {0, 0, 1}, tolerance);
        EXPECT_NEAR(vertex.uv0.x, uvs[2 * corners[i]], tolerance);
        EXPECT_NEAR(vertex.uv0.y, uvs[2 * corners[i] + 1], tolerance);
    }
    EXPECT_EQ(scene.triangleCount(), 2u);
}

/// Integers that stand for `values` in [-1; 1] (signed) or [0; 1].
template <typename T>
std::vector<T> quantized(const std::vector<float>& values) {
    std::vector<T> out;
    for (const float value : values)
        out.push_back(static_cast<T>(std::lround(value * float(std::numeric_limits<T>::max()))));
    return out;
}

/// `width` values of a vertex followed by padding up to a multiple of four bytes, as the specification asks of strides.
template <typename T>
std::vector<T> padded(const std::vector<T>& values, std::size_t width, std::size_t paddedWidth) {
    std::vector<T> out;
    for (std::size_t i = 0; i < values.size(); i += width) {
        for (std::size_t c = 0; c < paddedWidth; ++c) out.push_back(c < width ? values[i + c] : T(77));
    }
    return out;
}

template <typename T>
void replaceIndices(GltfBuilder& builder) {
    builder.document["meshes"][0]["primitives"][0]["indices"] = builder.accessor(Quad::indices<T>(), "SCALAR");
}

TEST(SceneMesh, IndicesOfEveryType) {
    GltfBuilder builder = quadBuilder();
    replaceIndices<std::uint8_t>(builder);
    expectQuad(builder.load());
    replaceIndices<std::uint16_t>(builder);
    expectQuad(builder.load());
    replaceIndices<std::uint32_t>(builder);
    expectQuad(builder.load());
}

TEST(SceneMesh, WithoutIndices) {
    std::vector<float> positions, normals, uvs;
    for (const std::uint32_t corner : Quad::indices<std::uint32_t>()) {
        for (std::size_t c = 0; c < 3; ++c) positions.push_back(Quad::positions()[3 * corner + c]);
        for (std::size_t c = 0; c < 3; ++c) normals.push_back(Quad::normals()[3 * corner + c]);
        for (std::size_t c = 0; c < 2; ++c) uvs.push_back(Quad::uvs()[2 * corner + c]);
    }
    GltfBuilder builder;
    const int position = builder.accessor(positions, "VEC3");
    const int normal = builder.accessor(normals, "VEC3");
    const int uv = builder.accessor(uvs, "VEC2");
    builder.addMesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}}});
    expectQuad(builder.load());
}

/// The quad with positions and normals of one integer type and uvs of another, all normalised.
template <typename Signed, typename Unsigned>
GltfBuilder quantizedBuilder() {
    constexpr std::size_t kWidth = 4;  // elements of 3 components are padded to 4
    GltfBuilder builder;
    builder.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    const auto add = [&](auto values, std::size_t width, const char* type) {
        using T = typename decltype(values)::value_type;
        const int view = builder.view(padded(values, width, kWidth), int(kWidth * sizeof(T)));
        return builder.addAccessor(view, GltfBuilder::componentType(T()), values.size() / width, type, true);
    };
    const int position = add(quantized<Signed>(Quad::positions()), 3, "VEC3");
    const int normal = add(quantized<Signed>(Quad::normals()), 3, "VEC3");
    const int uv = add(quantized<Unsigned>(Quad::uvs()), 2, "VEC2");
    const int indices = builder.accessor(Quad::indices<std::uint8_t>(), "SCALAR");
    builder.addMesh(
        {{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}}, {"indices", indices}});
    return builder;
}

TEST(SceneMesh, NormalizedAttributesOfEveryType) {
    // All values are -1, 0 or 1, which normalised integers hold exactly.
    expectQuad((quantizedBuilder<std::int8_t, std::uint8_t>().load()));
    expectQuad((quantizedBuilder<std::int16_t, std::uint16_t>().load()));
    expectQuad((quantizedBuilder<std::int16_t, std::int16_t>().load()));
    expectQuad((quantizedBuilder<std::int8_t, std::int8_t>().load()));
}

TEST(SceneMesh, NormalizedValuesFollowTheSpecification) {
    // glTF 2.0, 3.6.2.2: max(c / 127, -1), c / 255, max(c / 32767, -1), c / 65535.
    GltfBuilder builder = quadBuilder();
    Json& attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] =
        builder.addAccessor(builder.view(padded(std::vector<std::int8_t>{-128, -127, -64, 0, 1, 127, 64, 3}, 2, 4), 4),
                            5120, 4, "VEC2", true);
    attributes["TEXCOORD_1"] =
        builder.accessor(std::vector<std::int16_t>{-32768, -32767, -16384, 0, 1, 32767, 16384, 3}, "VEC2", true);
    attributes["COLOR_0"] = builder.accessor(
        std::vector<std::uint16_t>{0, 1, 32768, 65535, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", true);
    const Scene scene = builder.load();
    const std::vector<Vertex>& v = scene.meshes.at(0).vertices;
    EXPECT_EQ(v[0].uv0, glm::vec2(-1.0f, -1.0f));
    EXPECT_EQ(v[1].uv0, glm::vec2(-64.0f / 127.0f, 0.0f));
    EXPECT_EQ(v[2].uv0, glm::vec2(1.0f / 127.0f, 1.0f));
    EXPECT_EQ(v[0].uv1, glm::vec2(-1.0f, -1.0f));
    EXPECT_EQ(v[1].uv1, glm::vec2(-16384.0f / 32767.0f, 0.0f));
    EXPECT_EQ(v[2].uv1, glm::vec2(1.0f / 32767.0f, 1.0f));
    EXPECT_EQ(v[0].color, glm::vec4(0.0f, 1.0f / 65535.0f, 32768.0f / 65535.0f, 1.0f));
}

TEST(SceneMesh, IntegerPositionsKeepTheirValue) {
    GltfBuilder builder = quadBuilder();
    const std::vector<std::int16_t> positions = {-100, 100, 0, -100, -100, 0, 100, -100, 0, 100, 100, 0};
    builder.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
        builder.addAccessor(builder.view(padded(positions, 3, 4), 8), 5122, 4, "VEC3");
    const Scene scene = builder.load();
    EXPECT_EQ(scene.boundsMin, glm::vec3(-100, -100, 0));
    EXPECT_EQ(scene.boundsMax, glm::vec3(100, 100, 0));
}

TEST(SceneMesh, ColorsOfThreeComponentsAreOpaque) {
    GltfBuilder builder = quadBuilder();
    builder.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = builder.addAccessor(
        builder.view(padded(std::vector<std::uint8_t>{51, 102, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3, 4), 4), 5121, 4,
        "VEC3", true);
    const Scene scene = builder.load();
    EXPECT_EQ(scene.meshes.at(0).vertices[0].color, glm::vec4(0.2f, 0.4f, 1.0f, 1.0f));
}

TEST(SceneMesh, InterleavedIsAsPlanar) {
    GltfBuilder builder;
    std::vector<float> interleaved;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t c = 0; c < 3; ++c) interleaved.push_back(Quad::positions()[3 * i + c]);
        for (std::size_t c = 0; c < 3; ++c) interleaved.push_back(Quad::normals()[3 * i + c]);
        for (std::size_t c = 0; c < 2; ++c) interleaved.push_back(Quad::uvs()[2 * i + c]);
    }
    const int view = builder.view(interleaved, 32);
    const int position = builder.addAccessor(view, 5126, 4, "VEC3");
    const int normal = builder.addAccessor(view, 5126, 4, "VEC3", false, 12);
    const int uv = builder.addAccessor(view, 5126, 4, "VEC2", false, 24);
    const int indices = builder.accessor(Quad::indices<std::uint8_t>(), "SCALAR");
    builder.addMesh(
        {{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}}, {"indices", indices}});
    expectQuad(builder.load());
}

/// Replaces `accessors[index]` by a sparse one that changes `elements` to `values`.
void makeSparse(GltfBuilder& builder, int index, const std::vector<std::uint8_t>& elements,
                const std::vector<float>& values) {
    builder.document["accessors"][std::size_t(index)]["sparse"] = {
        {"count", elements.size()},
        {"indices", {{"bufferView", builder.view(elements)}, {"componentType", 5121}}},
        {"values", {{"bufferView", builder.view(values)}}}};
}

TEST(SceneMesh, SparseChangesSomeElements) {
    GltfBuilder builder = quadBuilder();
    std::vector<float> wrong = Quad::positions();
    wrong[3] = 9.0f;   // x of vertex 1
    wrong[11] = 9.0f;  // z of vertex 3
    const int position = builder.accessor(wrong, "VEC3");
    makeSparse(builder, position, {1, 3}, {-1, -1, 0, 1, 1, 0});
    builder.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = position;
    expectQuad(builder.load());
}

TEST(SceneMesh, SparseWithoutBufferViewStartsAtZero) {
    GltfBuilder builder = quadBuilder();
    const int uv = builder.addAccessor(-1, 5126, 4, "VEC2");
    makeSparse(builder, uv, {1, 2, 3}, {0, 1, 1, 1, 1, 0});
    builder.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uv;
    expectQuad(builder.load());
}

TEST(SceneMesh, StripsAndFans) {
    GltfBuilder builder = quadBuilder();
    Json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["mode"] = 5;
    primitive["indices"] = builder.accessor(std::vector<std::uint8_t>{0, 1, 3, 2}, "SCALAR");
    const Scene strip = builder.load();
    // glTF 2.0, 3.7.2.1: p_i = {v_i, v_(i + 1 + i % 2), v_(i + 2 - i % 2)}
    EXPECT_THAT(strip.meshes.at(0).indices, testing::ElementsAre(0, 1, 3, 1, 2, 3));
    primitive["mode"] = 6;
    primitive["indices"] = builder.accessor(std::vector<std::uint8_t>{0, 1, 2, 3}, "SCALAR");
    const Scene fan = builder.load();
    // p_i = {v_(i + 1), v_(i + 2), v_0}
    EXPECT_THAT(fan.meshes.at(0).indices, testing::ElementsAre(1, 2, 0, 2, 3, 0));
}

TEST(SceneMesh, TrianglesThatNameAVertexTwiceAreLeftOut) {
    GltfBuilder builder = quadBuilder();
    Json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["mode"] = 5;
    primitive["indices"] = builder.accessor(std::vector<std::uint8_t>{0, 1, 3, 3, 1, 1, 2, 3}, "SCALAR");
    EXPECT_EQ(builder.load().triangleCount(), 2u);
}

TEST(SceneMesh, PointsAndLinesAreNoted) {
    GltfBuilder builder = quadBuilder();
    builder.document["meshes"][0]["primitives"][0]["mode"] = 1;
    const Scene scene = builder.load();
    EXPECT_EQ(scene.meshes.size(), 0u);
    EXPECT_THAT(scene.notes, testing::ElementsAre(testing::HasSubstr("meshes[0].primitives[0]")));
    EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(SceneMesh, WithoutNormalsTrianglesAreFlat) {
    GltfBuilder builder;
    // A roof: two triangles that share the ridge from (0, 1, 0) to (0, 1, -1).
    const int position = builder.accessor(std::vector<float>{-1, 0, 0, 0, 1, 0, 0, 1, -1, 1, 0, 0}, "VEC3");
    const int indices = builder.accessor(std::vector<std::uint8_t>{0, 1, 2, 1, 3, 2}, "SCALAR");
    builder.addMesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
    const Scene scene = builder.load();
    const std::vector<Triangle> triangles = trianglesOf(scene.meshes.at(0));
    ASSERT_EQ(triangles.size(), 2u);
    const float half = std::sqrt(0.5f);
    for (const Vertex& vertex : triangles[0]) expectNear(vertex.normal, {-half, half, 0}, 1e-6f);  // rounding of a sqrt
    for (const Vertex& vertex : triangles[1]) expectNear(vertex.normal, {half, half, 0}, 1e-6f);
}

TEST(SceneMesh, NormalsWithoutDirectionAreReplaced) {
    GltfBuilder builder = quadBuilder();
    std::vector<float> normals = Quad::normals();
    normals[2] = 0.0f;
    normals[5] = 1e-30f;  // short, but a direction
    builder.document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = builder.accessor(normals, "VEC3");
    const Scene scene = builder.load();
    expectQuad(scene);
    EXPECT_THAT(scene.notes, testing::ElementsAre(testing::HasSubstr("1 normals")));
}

TEST(SceneMesh, MorphTargetsStandAtTheirWeights) {
    GltfBuilder builder = quadBuilder();
    const int up = builder.accessor(std::vector<float>{0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
    const int down = builder.accessor(std::vector<float>{0, -4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
    Json& mesh = builder.document["meshes"][0];
    mesh["primitives"][0]["targets"] = Json::array({Json{{"POSITION", up}}, Json{{"POSITION", down}}});
    mesh["weights"] = {0.5, 0.25};
    builder.add("nodes", {{"mesh", 0}, {"weights", {1.0, 0.0}}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.meshes.size(), 2u);  // the second node has weights of its own
    EXPECT_EQ(scene.meshes[0].vertices[0].position, glm::vec3(-1, 0, 1));
    EXPECT_EQ(scene.meshes[1].vertices[0].position, glm::vec3(-1, 1, 2));
}

TEST(SceneMesh, GlbIsAsGltf) {
    const TempFolder folder;
    expectQuad(loadGltf(folder.write("quad.glb", quadBuilder().glb())));
    expectQuad(loadGltf(folder.write("quad.gltf", quadBuilder().gltf())));
}

TEST(SceneMesh, BufferInAFileBesideIt) {
    const TempFolder folder;
    GltfBuilder builder = quadBuilder();
    const std::size_t length = builder.buffer.size();
    builder.document["buffers"] = Json::array({Json{{"byteLength", length}, {"uri", "data/the%20quad.bin"}}});
    ByteVector longer = builder.buffer;
    longer.resize(length + 3);  // glTF allows a file to hold more than the buffer
    folder.write("data/the quad.bin", longer);
    expectQuad(loadGltf(folder.write("quad.gltf", builder.gltf())));
}

}  // namespace
}  // namespace earthshine::raster::test
