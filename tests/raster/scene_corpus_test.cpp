// Files of others, and files of ours with bytes changed: whatever a file holds, it is a Scene or one line.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include "earthshine/error.hpp"
#include "raster/scene_support.hpp"

namespace earthshine::raster::test {
namespace {

namespace fs = std::filesystem;

bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x + v.y + v.z);
}

/// What every Scene promises to those who draw it.
void expectSound(const Scene& scene) {
    ASSERT_FALSE(scene.materials.empty());
    const auto expectTexture = [&](const TextureRef& ref) {
        ASSERT_GE(ref.texture, -1);
        ASSERT_LT(ref.texture, int(scene.textures.size()));
        ASSERT_TRUE(ref.texCoord == 0 || ref.texCoord == 1);
    };
    for (const Material& material : scene.materials) {
        for (const TextureRef& ref :
             {material.baseColorTexture, material.metallicTexture, material.normalTexture, material.emissionTexture}) {
            expectTexture(ref);
        }
        ASSERT_TRUE(isFinite(material.emission));
    }
    for (const Texture& texture : scene.textures) {
        const std::size_t channels = 4 * std::size_t(texture.widthPx) * std::size_t(texture.heightPx);
        ASSERT_GT(channels, 0u);
        ASSERT_EQ(texture.rgba8.size() + texture.rgba16.size(), channels);
        ASSERT_TRUE(texture.rgba8.empty() || texture.rgba16.empty());
    }
    for (const Mesh& mesh : scene.meshes) {
        ASSERT_GE(mesh.material, 0);
        ASSERT_LT(mesh.material, int(scene.materials.size()));
        ASSERT_EQ(mesh.indices.size() % 3, 0u);
        ASSERT_FALSE(mesh.indices.empty());
        for (const std::uint32_t index : mesh.indices) ASSERT_LT(index, mesh.vertices.size());
        for (const Vertex& vertex : mesh.vertices) {
            ASSERT_TRUE(isFinite(vertex.position));
            // Single precision: a normalisation is right to a few units in the last place.
            ASSERT_NEAR(glm::length(vertex.normal), 1.0f, 1e-5f);
            ASSERT_NEAR(glm::length(glm::vec3(vertex.tangent)), 1.0f, 1e-5f);
            ASSERT_EQ(std::abs(vertex.tangent.w), 1.0f);
        }
    }
    for (const Instance& instance : scene.instances) {
        ASSERT_GE(instance.mesh, 0);
        ASSERT_LT(instance.mesh, int(scene.meshes.size()));
    }
    for (const SceneLight& light : scene.lights) ASSERT_TRUE(isFinite(light.intensity));
    ASSERT_TRUE(isFinite(scene.boundsMax - scene.boundsMin));
}

/// Loads the file and checks what comes of it; true if it is a Scene.
bool loadsSoundly(const fs::path& path) {
    try {
        expectSound(loadGltf(path));
        return true;
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_THAT(message, testing::StartsWith(path.filename().string() + ": "));
        return false;
    }
}

TEST(SceneCorpus, ModelsOfAssimpLoadOrAreRefused) {
    // Debian's assimp-testmodels: sound files of the Khronos collection beside files that crashed loaders.
    const fs::path folder = EARTHSHINE_ASSIMP_MODELS;
    ASSERT_TRUE(fs::is_directory(folder / "glTF2"))
        << folder << " is not there: install assimp-testmodels or set the CMake variable EARTHSHINE_ASSIMP_MODELS";
    int files = 0, scenes = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".gltf" && extension != ".glb") continue;
        SCOPED_TRACE(entry.path());
        ++files;
        scenes += loadsSoundly(entry.path());
    }
    EXPECT_GE(files, 50);
    EXPECT_GE(scenes, 28);
}

TEST(SceneCorpus, KnownModels) {
    const fs::path folder = fs::path(EARTHSHINE_ASSIMP_MODELS) / "glTF2";
    const std::map<std::string, std::size_t> triangles = {
        {"BoxTextured-glTF/BoxTextured.gltf", 12},          {"BoxTextured-glTF-Binary/BoxTextured.glb", 12},
        {"BoxTextured-glTF-Embedded/BoxTextured.gltf", 12}, {"2CylinderEngine-glTF-Binary/2CylinderEngine.glb", 110342},
        {"ClearCoat-glTF/ClearCoatTest.gltf", 37116},       {"textureTransform/TextureTransformTest.gltf", 24}};
    for (const auto& [name, count] : triangles) EXPECT_EQ(loadGltf(folder / name).triangleCount(), count) << name;
    const std::map<std::string, const char*> refused = {
        {"draco/2CylinderEngine.gltf", "KHR_draco_mesh_compression"},
        {"RecursiveNodes/RecursiveNodes.gltf", "its own ancestor"},
        {"IndexOutOfRange/IndexOutOfRange.gltf", "is 255, but there are 24 vertices"},
        {"MissingBin/BoxTextured.gltf", "there is no such file"},
        {"BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "is not finite"},
        {"IncorrectVertexArrays/Cube.gltf", "buffers[0] holds 514 B"}};
    for (const auto& [name, what] : refused) EXPECT_THAT(refusalOf(folder / name), testing::HasSubstr(what)) << name;
}

/// A small .glb that has one of everything the loader reads.
ByteVector oneOfEverything() {
    GltfBuilder b = quadBuilder();
    Json& primitive = b.document["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] = b.accessor(std::vector<std::uint8_t>(16, 200), "VEC4", true);
    primitive["attributes"]["TEXCOORD_1"] = b.accessor(std::vector<std::uint16_t>(8, 999), "VEC2", true);
    b.document["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", b.view(std::vector<std::uint8_t>{2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", b.view(std::vector<float>{1, -1, 0})}}}};
    primitive["targets"] = Json::array({Json{{"POSITION", b.accessor(std::vector<float>(12, 0.5f), "VEC3")}}});
    b.document["meshes"][0]["weights"] = {0.5};
    const int color = b.addTexture(pngRgba8(), {{"wrapS", 33071}, {"magFilter", 9728}});
    const int normal = b.addTexture(pngRgb16());
    primitive["material"] = b.add(
        "materials",
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", color}, {"texCoord", 1}}}, {"metallicFactor", 0.5}}},
         {"normalTexture",
          {{"index", normal}, {"extensions", {{"KHR_texture_transform", {{"rotation", 1}, {"scale", {2, 2}}}}}}}},
         {"emissiveFactor", {1, 1, 0}},
         {"alphaMode", "MASK"},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}}}});
    b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.5}}}});
    const int light = b.addLight({{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}, {"color", {1, 1, 1}}});
    b.add("nodes", {{"camera", 0}, {"rotation", {0, 0, 0, 1}}, {"children", {0}}});
    b.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}, {"scale", {1, 2, 1}}});
    b.add("scenes", {{"nodes", {1, 2}}});
    return b.glb();
}

TEST(SceneCorpus, ChangedBytesNeverCrash) {
    const TempFolder folder;
    const ByteVector whole = oneOfEverything();
    ASSERT_TRUE(loadsSoundly(folder.write("fuzz.glb", whole)));
    const auto bin = std::size_t(std::search(whole.begin(), whole.end(), "BIN", "BIN" + 3) - whole.begin());
    ASSERT_LT(bin, whole.size());

    constexpr unsigned kSeed = 20240607;
    constexpr int kFiles = 6000;
    std::mt19937 random(kSeed);
    const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
    int scenes = 0;
    for (int i = 0; i < kFiles && !testing::Test::HasFailure(); ++i) {
        ByteVector file = whole;
        for (std::size_t change = 0; change <= below(3); ++change) {
            switch (below(5)) {
                case 0:  // any byte, any value
                    file[below(file.size())] = static_cast<unsigned char>(random());
                    break;
                case 1:  // a bit of the data: positions, indices, pictures
                    file[bin + below(file.size() - bin)] ^= static_cast<unsigned char>(1u << below(8));
                    break;
                case 2:  // the end is missing
                    if (below(8) == 0) file.resize(std::max<std::size_t>(below(file.size()), bin + 4));
                    break;
                default: {  // another digit in the document: counts, offsets, indices, types
                    const std::size_t start = 20 + below(bin - 20);
                    const auto digit =
                        std::find_if(file.begin() + std::ptrdiff_t(start), file.begin() + std::ptrdiff_t(bin),
                                     [](unsigned char c) { return c >= '0' && c <= '9'; });
                    static constexpr char kValues[] = "0123456789-e.9999";
                    *digit = static_cast<unsigned char>(kValues[below(sizeof kValues - 1)]);
                }
            }
        }
        SCOPED_TRACE(i);
        scenes += loadsSoundly(folder.write("fuzz.glb", file));
    }
    // Both outcomes must be common, or the changes test nothing.
    EXPECT_GT(scenes, kFiles / 10);
    EXPECT_LT(scenes, kFiles * 9 / 10);
}

}  // namespace
}  // namespace earthshine::raster::test
