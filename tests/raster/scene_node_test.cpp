// Nodes: where instances, cameras and lights end up.

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "raster/scene_support.hpp"

namespace earthshine::raster::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kHalfTurn[] = {0, 1, 0, 0};                                       // about y
constexpr double kQuarterTurn[] = {0, 0.7071067811865476, 0, 0.7071067811865476};  // about y: +z to +x
constexpr double kEighthTurn[] = {0, 0.3826834323650898, 0, 0.9238795325112867};
constexpr float kRounding = 1e-6f;  // of a few products near 1

glm::vec3 at(const glm::mat4& matrix, const glm::vec3& point) {
    return glm::vec3(matrix * glm::vec4(point, 1.0f));
}

void expectNear(const glm::vec3& a, const glm::vec3& b, float tolerance = kRounding) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

/// A rigid matrix: orthonormal, right-handed.
void expectRigid(const glm::mat4& matrix) {
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(glm::dot(glm::vec3(matrix[i]), glm::vec3(matrix[k])), i == k ? 1.0f : 0.0f, kRounding);
        }
    }
    EXPECT_NEAR(glm::determinant(matrix), 1.0f, 4 * kRounding);
}

TEST(SceneNodes, TranslateAfterRotateAfterScaleDownTheTree) {
    GltfBuilder builder = quadBuilder();
    builder.document["nodes"][0].update({{"translation", {1, 2, 3}}, {"rotation", kQuarterTurn}, {"scale", {2, 3, 4}}});
    builder.add("nodes", {{"translation", {100, 0, 0}}, {"rotation", kHalfTurn}, {"children", {0}}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    // (1, 1, 0): scaled (2, 3, 0), turned by 90 degrees (0, 3, -2), moved (1, 5, 1); turned by 180 (-1, 5, -1), moved.
    expectNear(at(scene.instances[0].worldFromObject, {1, 1, 0}), {99, 5, -1}, 1e-5f);  // rounding near 100
}

TEST(SceneNodes, MatrixIsColumnMajor) {
    GltfBuilder builder = quadBuilder();
    builder.document["nodes"][0]["matrix"] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1};
    const Scene scene = builder.load();
    expectNear(at(scene.instances.at(0).worldFromObject, {1, 0, 0}), {7, 9, 9});
}

TEST(SceneNodes, InstancesShareTheirMeshAndKeepTheirMirroring) {
    GltfBuilder builder = quadBuilder();
    builder.add("nodes", {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"translation", {5, 0, 0}}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.instances[1].mesh, 0);
    EXPECT_LT(glm::determinant(scene.instances[1].worldFromObject), 0.0f);
    EXPECT_EQ(scene.triangleCount(), 4u);
    EXPECT_EQ(scene.boundsMin, glm::vec3(-1, -1, 0));
    EXPECT_EQ(scene.boundsMax, glm::vec3(6, 1, 0));
    EXPECT_EQ(scene.meshes[0].boundsMin, glm::vec3(-1, -1, 0));
    EXPECT_EQ(scene.meshes[0].boundsMax, glm::vec3(1, 1, 0));
}

TEST(SceneNodes, TheDefaultSceneIsShown) {
    GltfBuilder builder = quadBuilder();
    builder.add("nodes", {{"mesh", 0}, {"translation", {5, 0, 0}}});
    builder.document["scenes"] = Json::array({Json{{"nodes", {0}}}, Json{{"name", "far"}, {"nodes", {1}}}});
    builder.document["scene"] = 1;
    const Scene scene = builder.load();
    EXPECT_EQ(scene.name, "far");
    ASSERT_EQ(scene.instances.size(), 1u);
    expectNear(at(scene.instances[0].worldFromObject, {0, 0, 0}), {5, 0, 0});
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("scenes[1]")));
}

TEST(SceneNodes, TreesOfAnyDepth) {
    constexpr int kDepth = 50000;  // recursion would run out of stack
    GltfBuilder builder = quadBuilder();
    for (int i = 0; i < kDepth; ++i) builder.add("nodes", {{"children", {i}}, {"translation", {0, 0, 1}}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].worldFromObject[3].z, float(kDepth));
}

TEST(SceneNodes, WithoutVolumeAreLeftOutWithANote) {
    GltfBuilder builder = quadBuilder();
    builder.document["nodes"][0]["scale"] = {1, 0, 1};
    const Scene scene = builder.load();
    EXPECT_THAT(scene.instances, IsEmpty());
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("nodes[0]")));
}

TEST(SceneNodes, TinyIsNotFlat) {
    GltfBuilder builder = quadBuilder();
    builder.document["nodes"][0]["scale"] = {1e-6, 1e-6, 1e-6};
    EXPECT_EQ(builder.load().instances.size(), 1u);
}

TEST(SceneNodes, MarkersOfEnginesAreDrawnOnRequestOnly) {
    for (const char* name : {"CasMoveLimit", "CasSector1", "UCX_wall_01", "UBX_", "floor-colonly", "a-navmesh"}) {
        GltfBuilder builder = quadBuilder();
        builder.document["nodes"][0]["name"] = name;
        EXPECT_THAT(builder.load().instances, IsEmpty()) << name;
        EXPECT_THAT(builder.load().notes, ElementsAre(HasSubstr("markers"))) << name;
        EXPECT_EQ(builder.load({.drawsMarkers = true}).instances.size(), 1u) << name;
    }
    for (const char* name : {"", "Casino", "Castle", "ucx_wall", "colonly", "-colonly wall"}) {
        GltfBuilder builder = quadBuilder();
        builder.document["nodes"][0]["name"] = name;
        EXPECT_EQ(builder.load().instances.size(), 1u) << name;
        EXPECT_THAT(builder.load().notes, IsEmpty()) << name;
    }
}

TEST(SceneNodes, SkinsAreNoted) {
    GltfBuilder builder = quadBuilder();
    builder.document["skins"] = Json::array({Json{{"joints", {0}}}});
    builder.document["nodes"][0]["skin"] = 0;
    EXPECT_THAT(builder.load().notes, ElementsAre(HasSubstr("skin")));
}

TEST(SceneCameras, Perspective) {
    GltfBuilder builder;
    builder.add("cameras", {{"type", "perspective"},
                            {"name", "eye"},
                            {"perspective", {{"yfov", 0.7}, {"znear", 0.5}, {"zfar", 20}, {"aspectRatio", 1.5}}}});
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.25}}}});
    builder.add("nodes", {{"camera", 0}, {"rotation", kQuarterTurn}, {"translation", {1, 2, 3}}});
    builder.add("nodes", {{"camera", 1}, {"name", "second"}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.cameras.size(), 2u);
    const SceneCamera& first = scene.cameras[0];
    EXPECT_EQ(first.name, "eye");
    EXPECT_TRUE(first.perspective);
    EXPECT_EQ(first.verticalFov, 0.7f);
    EXPECT_EQ(first.aspect, 1.5f);
    EXPECT_EQ(first.nearM, 0.5f);
    EXPECT_EQ(first.farM, 20.0f);
    expectNear(at(first.worldFromView, {0, 0, -1}), {0, 2, 3});  // -z turned to -x
    const SceneCamera& second = scene.cameras[1];
    EXPECT_EQ(second.name, "second");
    EXPECT_EQ(second.aspect, 0.0f);
    EXPECT_EQ(second.farM, 0.0f);  // infinite
}

TEST(SceneCameras, OrthographicAndRigidUnderScale) {
    GltfBuilder builder;
    builder.add("cameras",
                {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}});
    builder.add("nodes", {{"camera", 0}, {"rotation", kEighthTurn}});
    builder.add("nodes", {{"scale", {-2, 3, 4}}, {"translation", {1, 2, 3}}, {"children", {0}}});
    const Scene scene = builder.load();
    const SceneCamera& camera = scene.cameras.at(0);
    EXPECT_FALSE(camera.perspective);
    EXPECT_EQ(camera.halfHeightM, 2.0f);
    EXPECT_EQ(camera.aspect, 2.0f);
    EXPECT_EQ(camera.nearM, 0.0f);
    EXPECT_EQ(camera.farM, 9.0f);
    expectRigid(camera.worldFromView);
    // -z, turned to (-1, 0, -1) by the node, is mirrored and sheared to (2, 0, -4); up stays up.
    expectNear(-glm::vec3(camera.worldFromView[2]), glm::normalize(glm::vec3(2, 0, -4)));
    expectNear(glm::vec3(camera.worldFromView[1]), {0, 1, 0});
    expectNear(glm::vec3(camera.worldFromView[3]), {1, 2, 3});
}

TEST(SceneLights, DefaultsOfTheExtension) {
    GltfBuilder builder;
    for (const char* type : {"directional", "point"}) {
        builder.add("nodes",
                    {{"extensions", {{"KHR_lights_punctual", {{"light", builder.addLight({{"type", type}})}}}}}});
    }
    const int spot = builder.addLight({{"type", "spot"}, {"spot", Json::object()}});
    builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", spot}}}}}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].type, SceneLightType::Directional);
    EXPECT_EQ(scene.lights[1].type, SceneLightType::Point);
    EXPECT_EQ(scene.lights[2].type, SceneLightType::Spot);
    for (const SceneLight& light : scene.lights) {
        EXPECT_EQ(light.intensity, glm::vec3(1.0f));
        EXPECT_EQ(light.rangeM, 0.0f);
        EXPECT_EQ(light.innerConeAngle, 0.0f);
        EXPECT_EQ(light.outerConeAngle, float(std::numbers::pi / 4));
        EXPECT_EQ(light.worldFromLight, glm::mat4(1.0f));
    }
}

TEST(SceneLights, ValuesAndPlace) {
    GltfBuilder builder;
    const int light = builder.addLight({{"name", "lamp"},
                                        {"type", "spot"},
                                        {"color", {1, 0.5, 0.25}},
                                        {"intensity", 80},
                                        {"range", 12},
                                        {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.6}}}});
    // A second light behind the first: instances of one definition.
    builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}},
                          {"rotation", kQuarterTurn},
                          {"scale", {5, 5, 5}}});
    builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}, {"translation", {0, 3, 0}}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.lights.size(), 2u);
    const SceneLight& first = scene.lights[0];
    EXPECT_EQ(first.name, "lamp");
    EXPECT_EQ(first.intensity, glm::vec3(80, 40, 20));
    EXPECT_EQ(first.rangeM, 12.0f);
    EXPECT_EQ(first.innerConeAngle, 0.3f);
    EXPECT_EQ(first.outerConeAngle, 0.6f);
    expectRigid(first.worldFromLight);
    expectNear(-glm::vec3(first.worldFromLight[2]), {-1, 0, 0});
    expectNear(glm::vec3(scene.lights[1].worldFromLight[3]), {0, 3, 0});
}

TEST(SceneLights, WithoutDirectionAreLeftOutWithANote) {
    GltfBuilder builder;
    const int light = builder.addLight({{"type", "directional"}});
    builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}, {"scale", {0, 0, 0}}});
    const Scene scene = builder.load();
    EXPECT_THAT(scene.lights, IsEmpty());
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("nodes[0]")));
}

}  // namespace
}  // namespace earthshine::raster::test
