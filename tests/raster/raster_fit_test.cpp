// What lights' maps and cameras cover, and how a sun and cameras are named.

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "earthshine/error.hpp"
#include "earthshine/log.hpp"
#include "raster/camera_fit.hpp"
#include "raster/light_fit.hpp"
#include "raster/raster_support.hpp"

namespace earthshine::raster::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// What is logged while `act` runs.
template <typename Act>
std::vector<std::string> linesLogged(Act act) {
    std::vector<std::string> lines;
    setLogSink([&](LogLevel, std::string_view line) { lines.emplace_back(line); });
    act();
    setLogSink({});
    return lines;
}

glm::mat4 randomRotation(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const auto vector = [&] { return glm::vec3(normal(random), normal(random), normal(random)); };
    return glm::rotate(glm::mat4(1), normal(random) * 3.0f, glm::normalize(vector()));
}

/// Boxes strewn about `centre`.
Scene strewnBoxes(std::mt19937& random, const glm::vec3& centre) {
    std::uniform_real_distribution<float> place(-5, 5);
    std::uniform_real_distribution<float> size(0.1f, 3);
    Scene scene;
    scene.name = "boxes.gltf";
    scene.materials = {diffuse(glm::vec3(0.5f))};
    scene.meshes = {unitBox(0)};
    glm::vec3 low(1e30f), high(-1e30f);
    for (int i = 0; i < 6; ++i) {
        const glm::mat4 placed =
            glm::translate(glm::mat4(1), centre + glm::vec3(place(random), place(random), place(random)));
        scene.instances.push_back(
            {0, glm::scale(placed * randomRotation(random), glm::vec3(size(random), -size(random), size(random)))});
        for (const Vertex& vertex : scene.meshes[0].vertices) {
            const glm::vec3 position(scene.instances.back().worldFromObject * glm::vec4(vertex.position, 1));
            low = glm::min(low, position);
            high = glm::max(high, position);
        }
    }
    scene.boundsMin = low;
    scene.boundsMax = high;
    return scene;
}

SceneLight sceneLight(SceneLightType type, const glm::mat4& worldFromLight, const char* name = "lamp") {
    SceneLight light;
    light.name = name;
    light.type = type;
    light.intensity = {1, 2, 3};
    light.worldFromLight = worldFromLight;
    return light;
}

/// The box of all vertices in NDC. The camera's matrices are floats; they are multiplied in doubles, as SceneGl does.
std::pair<glm::vec3, glm::vec3> ndcBounds(const Scene& scene, const Camera& camera) {
    glm::vec3 low(1e30f), high(-1e30f);
    for (const Instance& instance : scene.instances) {
        for (const Vertex& vertex : scene.meshes[std::size_t(instance.mesh)].vertices) {
            const glm::dvec4 world = glm::dmat4(instance.worldFromObject) * glm::dvec4(vertex.position, 1);
            const glm::dvec4 clip = glm::dmat4(camera.clipFromView) * (glm::dmat4(camera.viewFromWorld) * world);
            low = glm::min(low, glm::vec3(clip / clip.w));
            high = glm::max(high, glm::vec3(clip / clip.w));
        }
    }
    return {low, high};
}

TEST(RasterFit, DirectionalMapsHoldEveryVertexTightly) {
    std::mt19937 random(7);
    for (int i = 0; i < 50; ++i) {
        const float distance = i % 2 ? 1e5f : 0.0f;
        Scene scene = strewnBoxes(random, glm::vec3(distance, -distance, distance));
        const glm::mat4 worldFromLight = randomRotation(random);
        scene.lights = {sceneLight(SceneLightType::Directional, worldFromLight)};
        const std::vector<Light> lights = fitLights(scene);
        ASSERT_EQ(lights.size(), 1u);
        EXPECT_EQ(lights[0].type, LightType::Directional);
        EXPECT_EQ(lights[0].intensity, glm::vec3(1, 2, 3));
        EXPECT_EQ(lights[0].name, "lamp");
        const auto [low, high] = ndcBounds(scene, lights[0].camera);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(low[axis], -1.0f);
            EXPECT_LE(high[axis], 1.0f);
            // The margin is 1e-4 of the side, and 2e-7 of coordinates up to 1.8e5 m on sides of at least 5 m.
            EXPECT_LT(low[axis], i % 2 ? -0.98f : -0.9997f);
            EXPECT_GT(high[axis], i % 2 ? 0.98f : 0.9997f);
        }
        const glm::vec3 along =
            glm::vec3(glm::transpose(glm::mat3(lights[0].camera.viewFromWorld)) * glm::vec3(0, 0, -1));
        EXPECT_LT(glm::length(along - glm::vec3(worldFromLight * glm::vec4(0, 0, -1, 0))), 1e-5f);
    }
}

TEST(RasterFit, AFlatSceneSeenEdgeOnHasAMap) {
    const Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    const Light light = sunLight({90, 0, 1}, scene);
    EXPECT_GT(texelPowerOnAxis(light, {64, 64}), 0.0f);
    const auto [low, high] = ndcBounds(scene, light.camera);
    EXPECT_GE(glm::min(low.x, glm::min(low.y, low.z)), -1.0f);
    EXPECT_LE(glm::max(high.x, glm::max(high.y, high.z)), 1.0f);
}

TEST(RasterFit, AnEmptySceneHasAMap) {
    EXPECT_GT(texelPowerOnAxis(sunLight({}, Scene()), {64, 64}), 0.0f);
}

TEST(RasterFit, SpotMapsHoldTheConeAndWhatItCanReach) {
    std::mt19937 random(11);
    for (int i = 0; i < 50; ++i) {
        Scene scene = strewnBoxes(random, glm::vec3(0));
        SceneLight source =
            sceneLight(SceneLightType::Spot, glm::translate(glm::mat4(1), {1, 2, 3}) * randomRotation(random));
        source.innerConeAngle = 0.1f;
        source.outerConeAngle = 0.9f;
        source.rangeM = i % 2 ? 3.0f : 0.0f;
        scene.lights = {source};
        const std::vector<Light> lights = fitLights(scene);
        ASSERT_EQ(lights.size(), 1u);
        const Light& light = lights[0];
        EXPECT_EQ(light.type, LightType::Spot);
        EXPECT_EQ(light.innerConeAngle, 0.1f);
        EXPECT_EQ(light.outerConeAngle, 0.9f);
        EXPECT_EQ(light.rangeM, source.rangeM);
        EXPECT_NEAR(double(light.camera.clipFromView[0][0]), 1.0 / std::tan(0.9), 1e-6);
        EXPECT_EQ(light.camera.clipFromView[0][0], light.camera.clipFromView[1][1]);
        const glm::vec4 origin = light.camera.viewFromWorld * source.worldFromLight * glm::vec4(0, 0, 0, 1);
        EXPECT_LT(glm::length(glm::vec3(origin)), 1e-5f);
        for (const Instance& instance : scene.instances) {
            for (const Vertex& vertex : scene.meshes[0].vertices) {
                const glm::vec4 view =
                    light.camera.viewFromWorld * (instance.worldFromObject * glm::vec4(vertex.position, 1));
                const glm::vec4 clip = light.camera.clipFromView * view;
                const bool inRange = source.rangeM == 0.0f || glm::length(glm::vec3(view)) <= source.rangeM;
                const bool isAhead = -view.z > 0.02f;  // a thousandth of the greatest depth there can be
                if (inRange && isAhead) {
                    EXPECT_LE(clip.z, clip.w);
                    EXPECT_GE(clip.z, -clip.w);
                }
            }
        }
    }
}

TEST(RasterFit, ASpotThatLooksAwayFromEverythingHasAMap) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.lights = {sceneLight(SceneLightType::Spot, glm::translate(glm::mat4(1), {0, 0, -5}))};  // looks along -z
    const HostFrame frame =
        drawScene(scene, lookAtCamera({0, 0, 3}, {0, 0, 0}, {1, 1}), {{1, 1}, 4, 4}, fitLights(scene));
    EXPECT_EQ(rgba(frame.rsmFlux, 1, 1), glm::vec4(0));
}

TEST(RasterFit, AHalfSpaceSpotIsCutAndSaid) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.lights = {sceneLight(SceneLightType::Spot, glm::mat4(1), "flood")};
    scene.lights[0].outerConeAngle = glm::half_pi<float>();
    std::vector<Light> lights;
    const auto lines = linesLogged([&] { lights = fitLights(scene); });
    EXPECT_THAT(lines, ElementsAre(HasSubstr("light \"flood\": its cone reaches 90.0 degrees")));
    EXPECT_GT(lights[0].camera.clipFromView[0][0], 0.08f);
}

TEST(RasterFit, TheSunStandsWhereItsBearingSays) {
    const auto expectDirection = [](const Sun& sun, const glm::vec3& expected) {
        EXPECT_LT(glm::length(directionToSun(sun) - expected), 1e-6f) << sun.azimuthDeg << ", " << sun.elevationDeg;
        const Light light = sunLight(sun, Scene());
        const glm::vec3 along = glm::transpose(glm::mat3(light.camera.viewFromWorld)) * glm::vec3(0, 0, -1);
        EXPECT_LT(glm::length(along + expected), 1e-6f);
        EXPECT_NEAR(glm::determinant(glm::mat3(light.camera.viewFromWorld)), 1.0f, 1e-6f);
    };
    expectDirection({0, 0}, {0, 0, -1});
    expectDirection({90, 0}, {1, 0, 0});
    expectDirection({180, 0}, {0, 0, 1});
    expectDirection({270, 0}, {-1, 0, 0});
    expectDirection({0, 90}, {0, 1, 0});
    expectDirection({90, 30}, {std::sqrt(0.75f), 0.5f, 0});
    EXPECT_THROW(directionToSun({0, 91}), UsageError);
    EXPECT_THROW(directionToSun({0, 0, -1}), UsageError);
    EXPECT_THROW(directionToSun({std::numeric_limits<float>::quiet_NaN(), 0}), UsageError);
}

TEST(RasterFit, AGivenSunStandsInForDirectionalLights) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.lights = {sceneLight(SceneLightType::Directional, glm::mat4(1), "day"),
                    sceneLight(SceneLightType::Spot, glm::mat4(1), "lamp"),
                    sceneLight(SceneLightType::Directional, glm::mat4(1), "sky")};
    const auto names = [](const std::vector<Light>& lights) {
        std::vector<std::string> result;
        for (const Light& light : lights) result.push_back(light.name);
        return result;
    };
    EXPECT_THAT(names(fitLights(scene)), ElementsAre("day", "lamp", "sky"));
    const std::vector<Light> lights = fitLights(scene, {Sun{10, 20, 300}});
    EXPECT_THAT(names(lights), ElementsAre("sun", "lamp"));
    EXPECT_EQ(lights[0].intensity, glm::vec3(300));
}

TEST(RasterFit, ALightsMapStaysToTheBitWhileObjectsMoveWithinReach) {
    std::mt19937 random(5);
    Scene scene = strewnBoxes(random, glm::vec3(0));
    scene.lights = {sceneLight(SceneLightType::Directional, randomRotation(random)),
                    sceneLight(SceneLightType::Spot, glm::translate(glm::mat4(1), {1, 2, 30}))};
    const glm::mat4 placed = scene.instances[0].worldFromObject;
    const WorldBox reach{glm::vec3(-20), glm::vec3(20)};
    const auto fitted = [&](float x, std::span<const WorldBox> boxes) {
        scene.instances[0].worldFromObject = glm::translate(glm::mat4(1), {x, 0, 0}) * placed;
        return fitLights(scene, {std::nullopt, boxes});
    };
    const std::vector<Light> before = fitted(-8, {&reach, 1}), after = fitted(8, {&reach, 1});
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(before[std::size_t(i)].camera.viewFromWorld, after[std::size_t(i)].camera.viewFromWorld);
        EXPECT_EQ(before[std::size_t(i)].camera.clipFromView, after[std::size_t(i)].camera.clipFromView);
    }
    EXPECT_NE(fitted(-8, {})[0].camera.clipFromView, fitted(8, {})[0].camera.clipFromView);
    // Nothing that is outside is lost.
    const std::vector<Light> outside = fitted(100, {&reach, 1});
    const auto [low, high] = ndcBounds(scene, outside[0].camera);
    EXPECT_GE(glm::min(low.x, glm::min(low.y, low.z)), -1.0f);
    EXPECT_LE(glm::max(high.x, glm::max(high.y, high.z)), 1.0f);
}

TEST(RasterFit, ALightAsASunShinesAlike) {
    std::mt19937 random(9);
    const Scene scene = strewnBoxes(random, glm::vec3(0));
    for (int i = 0; i < 20; ++i) {
        const SceneLight source = sceneLight(SceneLightType::Directional, randomRotation(random));
        const Light light = sunLight(sunOf(source), scene);
        const glm::vec3 toLight = glm::transpose(glm::mat3(light.camera.viewFromWorld)) * glm::vec3(0, 0, 1);
        EXPECT_LT(glm::length(toLight - glm::vec3(source.worldFromLight[2])), 1e-5f);  // degrees are floats
        EXPECT_LT(glm::length(light.intensity - source.intensity), 1e-6f);
    }
}

TEST(RasterFit, WhatWasSaidIsNotSaidAgain) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.lights = {sceneLight(SceneLightType::Point, glm::mat4(1))};
    EXPECT_EQ(linesLogged([&] { fitLights(scene); }).size(), 2u);
    EXPECT_EQ(linesLogged([&] { fitLights(scene, {std::nullopt, {}, false}); }).size(), 0u);
}

TEST(RasterFit, PointLightsAndMissingLightsAreSaid) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.lights = {sceneLight(SceneLightType::Point, glm::mat4(1)), sceneLight(SceneLightType::Point, glm::mat4(1)),
                    sceneLight(SceneLightType::Spot, glm::mat4(1))};
    EXPECT_THAT(linesLogged([&] { fitLights(scene); }), ElementsAre(HasSubstr("2 point lights are not drawn: ")));
    scene.lights.resize(1);
    std::vector<Light> lights;
    const auto lines = linesLogged([&] { lights = fitLights(scene); });
    EXPECT_THAT(lines, ElementsAre(HasSubstr("1 point light is not drawn: "), HasSubstr("a sun of 50000 lx")));
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(lights[0].name, "sun");
}

SceneCamera sceneCamera(const char* name, double verticalFov) {
    SceneCamera camera;
    camera.name = name;
    camera.verticalFov = float(verticalFov);
    camera.worldFromView = glm::translate(glm::mat4(1), {1, 2, 3});
    return camera;
}

TEST(RasterFit, CamerasAreFoundByNameOrNumber) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.cameras = {sceneCamera("left", 0.5), sceneCamera("0", 0.6), sceneCamera("", 0.7)};
    const auto fov = [&](std::string_view which) {
        return 2.0 * std::atan(1.0 / double(cameraFor(scene, which, {200, 100}).clipFromView[1][1]));
    };
    EXPECT_NEAR(fov(""), 0.5, 1e-6);
    EXPECT_NEAR(fov("left"), 0.5, 1e-6);
    EXPECT_NEAR(fov("0"), 0.6, 1e-6);  // a name goes before a number
    EXPECT_NEAR(fov("2"), 0.7, 1e-6);
    for (const char* which : {"3", "-1", "right", "1x"}) {
        try {
            cameraFor(scene, which, {200, 100});
            ADD_FAILURE() << which;
        } catch (const UsageError& error) {
            EXPECT_THAT(error.what(), HasSubstr("quad.gltf: there is no camera"));
            EXPECT_THAT(error.what(), HasSubstr("0 \"left\", 1 \"0\""));
        }
    }
    EXPECT_THROW(cameraFor(scene, "", {0, 100}), UsageError);
}

TEST(RasterFit, CamerasKeepTheirHeightAndTakeThePicturesAspect) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.cameras = {sceneCamera("infinite", 0.5), sceneCamera("finite", 0.5), sceneCamera("flat", 0.5)};
    scene.cameras[1].farM = 7.0f;
    scene.cameras[1].nearM = 0.5f;
    scene.cameras[2].perspective = false;
    scene.cameras[2].halfHeightM = 4.0f;
    scene.cameras[2].farM = 50.0f;
    const Extent extent{300, 100};
    for (const char* which : {"infinite", "finite", "flat"}) {
        const Camera camera = cameraFor(scene, which, extent);
        EXPECT_NEAR(double(camera.clipFromView[1][1] / camera.clipFromView[0][0]), 3.0, 1e-6) << which;
        EXPECT_LT(glm::length(glm::vec3(camera.viewFromWorld * glm::vec4(1, 2, 3, 1))), 1e-6f);
    }
    const auto ndcZ = [&](const char* which, float depth) {
        const glm::vec4 clip = cameraFor(scene, which, extent).clipFromView * glm::vec4(0, 0, -depth, 1);
        return double(clip.z / clip.w);
    };
    EXPECT_NEAR(ndcZ("finite", 0.5f), -1.0, 1e-6);
    EXPECT_NEAR(ndcZ("finite", 7.0f), 1.0, 1e-6);
    EXPECT_NEAR(ndcZ("infinite", 0.1f), -1.0, 1e-6);
    EXPECT_LE(ndcZ("infinite", 1e9f), 1.0);
    EXPECT_NEAR(ndcZ("flat", 50.0f), 1.0, 1e-6);
    EXPECT_NEAR(double(cameraFor(scene, "flat", extent).clipFromView[1][1]), 0.25, 1e-6);
}

TEST(RasterFit, TheDefaultViewHoldsTheScene) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> number(0.05f, 5.0f);
    for (const Extent extent : {Extent{1920, 1080}, Extent{100, 700}, Extent{1, 1}}) {
        for (int i = 0; i < 10; ++i) {
            const glm::vec3 centre(number(random), 10.0f * float(i), number(random));
            const glm::vec3 half(number(random), number(random), number(random));
            Scene scene;
            scene.meshes = {unitBox(0)};
            scene.instances = {{0, glm::scale(glm::translate(glm::mat4(1), centre), half)}};
            scene.boundsMin = centre - half;
            scene.boundsMax = centre + half;
            const auto [low, high] = ndcBounds(scene, cameraFor(scene, "", extent));
            EXPECT_GE(glm::min(low.x, glm::min(low.y, low.z)), -1.0f);
            EXPECT_LE(glm::max(high.x, glm::max(high.y, high.z)), 1.0f);
            EXPECT_GT(glm::max(high.x - low.x, high.y - low.y), 1.0f);  // and fills at least half of a side
        }
    }
}

}  // namespace
}  // namespace earthshine::raster::test
