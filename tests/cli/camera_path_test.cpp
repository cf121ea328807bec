// Camera and sun paths against closed forms, and files of key frames that are wrong.

#include "cli/camera_path.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "cli/key_frames.hpp"
#include "earthshine/error.hpp"
#include "image/temp_folder.hpp"

namespace earthshine::cli {
namespace {

using test::TempFolder;
using ::testing::HasSubstr;

constexpr double kFps = 30.0;
constexpr float kRounding = 2e-6f;  // of matrices of floats near 1

Camera camera(const glm::dvec3& position, const glm::dvec3& target) {
    return {glm::mat4(glm::lookAt(position, target, glm::dvec3(0, 1, 0))),
            glm::mat4(glm::perspective(0.7, 1.5, 0.1, 50.0))};
}

void expectNear(const glm::mat4& a, const glm::mat4& b) {
    for (int i = 0; i < 4; ++i) EXPECT_LT(glm::length(a[i] - b[i]), 4 * kRounding) << "column " << i;
}

glm::dvec3 positionOf(const Camera& of) {
    return glm::dvec3(glm::inverse(glm::dmat4(of.viewFromWorld))[3]);
}

KeyFrames keysOf(const std::string& json) {
    const TempFolder folder;
    test::writeText(folder / "keys.json", json);
    return readKeyFrames(folder / "keys.json", kFps);
}

raster::Scene sceneOf(const glm::vec3& boundsMin, const glm::vec3& boundsMax) {
    raster::Scene scene;
    scene.boundsMin = boundsMin;
    scene.boundsMax = boundsMax;
    return scene;
}

TEST(CameraPath, OrbitsCounterClockwiseAndKeepsLookingAtThePivot) {
    const Camera start = camera({0, 2, 5}, {0, 1, 0});
    // A quarter turn about +y takes +z to +x.
    expectNear(orbited(start, {0, 1, 0}, 90).viewFromWorld, camera({5, 2, 0}, {0, 1, 0}).viewFromWorld);
    expectNear(orbited(start, {0, 1, 0}, -30).viewFromWorld,
               camera({-2.5, 2, 5 * std::sqrt(0.75)}, {0, 1, 0}).viewFromWorld);
    EXPECT_EQ(orbited(start, {0.1, 1.7, -0.3}, 0).viewFromWorld, start.viewFromWorld);
    EXPECT_EQ(orbited(start, {0, 1, 0}, 90).clipFromView, start.clipFromView);
}

TEST(CameraPath, ThePivotIsOnTheViewAxisNearTheMiddleOfTheScene) {
    const raster::Scene scene = sceneOf({-1, -1, -1}, {3, 1, 1});
    const auto expectPivot = [&](const Camera& from, const glm::dvec3& expected) {
        EXPECT_LT(glm::length(orbitPivot(from, scene) - expected), 1e-5);
    };
    expectPivot(camera({0, 0, 5}, {0, 0, 0}), {0, 0, 0});  // the middle, (1, 0, 0), on the axis x = 0
    // With the middle behind it, and with the middle just ahead: a quarter of the diagonal, sqrt(24) / 4, ahead.
    expectPivot(camera({0, 0, 5}, {0, 0, 9}), {0, 0, 5 + std::sqrt(24.0) / 4});
    expectPivot(camera({0, 0, 0.1}, {0, 0, 0}), {0, 0, 0.1 - std::sqrt(24.0) / 4});
}

TEST(CameraPath, WordsAndFiles) {
    EXPECT_EQ(parsePath("orbit").degreesPerFrame, 1.0);
    EXPECT_EQ(parsePath("orbit:-2.5").degreesPerFrame, -2.5);
    EXPECT_EQ(parsePath("animation").animation, "");
    EXPECT_EQ(parsePath("animation:a:b").animation, "a:b");
    EXPECT_EQ(parsePath("orbit.json").kind, PathKind::Keys);
    for (const char* text : {"", "orbit:", "orbit:1e9", "animation:", "animations", "path.txt"})
        EXPECT_THROW(parsePath(text), UsageError) << text;
    EXPECT_EQ(parseSunPath("0.5,-1").elevationDegPerFrame, -1.0);
    EXPECT_EQ(parseSunPath("sun.json").file, "sun.json");
    for (const char* text : {"", "1", "1,2,3", "a,b"}) EXPECT_THROW(parseSunPath(text), UsageError) << text;
}

TEST(CameraPath, TheSunGoesOverTheZenith) {
    const raster::Sun start{10, 80, 500, {1, 0.5, 0.25}};
    const SunPathChoice path{1, 4, ""};
    for (int frame = 0; frame < 100; ++frame) {
        const raster::Sun sun = movedSun(start, path, frame);
        // The direction that the same angles give without a thought of their range.
        const double a = glm::radians(10.0 + frame), e = glm::radians(80.0 + 4.0 * frame);
        const glm::dvec3 expected(std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e));
        EXPECT_LT(glm::length(glm::dvec3(raster::directionToSun(sun)) - expected), 1e-5) << frame;
        EXPECT_EQ(sun.lux, 500);
        EXPECT_EQ(sun.color, start.color);
    }
}

TEST(KeyFramesOf, CamerasPassThroughTheirKeysAndHoldTheirEnds) {
    const KeyFrames keys = keysOf(R"({"comment": "one", "keys": [
        {"frame": 2, "position": [0, 1, 4], "target": [0, 1, 0]},
        {"time": 0.2, "position": [2, 1, 4], "target": [0, 2, 0]},
        {"frame": 10, "position": [3, 0, 1], "target": [1, 0, 0]}]})");
    const Camera start = camera({9, 9, 9}, {0, 0, 0});
    const auto expectAt = [&](double frame, const Camera& expected) {
        expectNear(cameraAt(keys.camera, frame, start).viewFromWorld, expected.viewFromWorld);
        EXPECT_EQ(cameraAt(keys.camera, frame, start).clipFromView, start.clipFromView);
    };
    for (const double frame : {0.0, 2.0}) expectAt(frame, camera({0, 1, 4}, {0, 1, 0}));
    expectAt(6.0, camera({2, 1, 4}, {0, 2, 0}));  // 0.2 s at 30 frames a second
    for (const double frame : {10.0, 99.0}) expectAt(frame, camera({3, 0, 1}, {1, 0, 0}));
}

TEST(KeyFramesOf, TheSplineIsExactForParabolas) {
    // x = f^2 / 16 at unequal distances. Slopes within are the parabola's own, so that it is met between them; in the
    // first and last piece the slope at the end is the chord's.
    const KeyFrames keys = keysOf(R"({"keys": [
        {"frame": 0,  "position": [0, 0, 4],    "rotation": [0, 0, 0, 1]},
        {"frame": 4,  "position": [1, 0, 4],    "rotation": [0, 0, 0, 1]},
        {"frame": 6,  "position": [2.25, 0, 4], "rotation": [0, 0, 0, 1]},
        {"frame": 12, "position": [9, 0, 4],    "rotation": [0, 0, 0, 1]},
        {"frame": 16, "position": [16, 0, 4],   "rotation": [0, 0, 0, 1]}]})");
    for (const double frame : {4.0, 5.0, 5.5, 6.0, 7.0, 10.0, 11.9})
        EXPECT_NEAR(positionOf(cameraAt(keys.camera, frame, {})).x, frame * frame / 16, 1e-5) << frame;
    // Hermite between 0 and 1 in four frames, slopes 1/4 (the chord) and 1/2 (the parabola), half way: 1/2 + 4/8 (1/4 -
    // 1/2).
    EXPECT_NEAR(positionOf(cameraAt(keys.camera, 2.0, {})).x, 0.375, 1e-6);
}

TEST(KeyFramesOf, RotationsTakeTheShorterWay) {
    const KeyFrames keys = keysOf(R"({"keys": [
        {"frame": 0, "position": [0, 0, 0], "rotation": [0, 0, 0, 1]},
        {"frame": 8, "position": [0, 0, 0], "rotation": [0, -0.70710678, 0, -0.70710678]}]})");
    // Half way of a quarter turn about y, by symmetry 45 degrees: the view axis goes from -z to -x.
    const Camera half = cameraAt(keys.camera, 4.0, {});
    const glm::vec3 forward = -glm::vec3(glm::transpose(half.viewFromWorld)[2]);
    EXPECT_LT(glm::length(forward - glm::vec3(-std::sqrt(0.5f), 0, -std::sqrt(0.5f))), kRounding);
}

TEST(KeyFramesOf, FieldsOfViewReplaceTheLens) {
    const KeyFrames keys = keysOf(R"({"keys": [
        {"frame": 0, "position": [0, 0, 4], "target": [0, 0, 0], "fov": 90},
        {"frame": 4, "position": [0, 0, 4], "target": [0, 0, 0], "fov": 60}]})");
    const Camera start = camera({0, 0, 4}, {0, 0, 0});
    const Camera wide = cameraAt(keys.camera, 0.0, start);
    EXPECT_NEAR(wide.clipFromView[1][1], 1.0f, 1e-6f);
    EXPECT_NEAR(wide.clipFromView[0][0], 1.0f / 1.5f, 1e-6f);
    EXPECT_EQ(wide.clipFromView[2], start.clipFromView[2]);
    EXPECT_NEAR(cameraAt(keys.camera, 4.0, start).clipFromView[1][1], std::sqrt(3.0f), 1e-5f);
    Camera flat = start;
    flat.clipFromView = glm::ortho(-1.0f, 1.0f, -1.0f, 1.0f, 0.1f, 9.0f);
    EXPECT_THROW(cameraAt(keys.camera, 0.0, flat), InputError);
}

TEST(KeyFramesOf, AStepHoldsAndThenJumps) {
    const KeyFrames keys = keysOf(R"({"keys": [
        {"frame": 0, "position": [0, 0, 4], "target": [0, 0, 0], "sun": [0, 10, 100]},
        {"frame": 4, "position": [4, 0, 4], "target": [0, 0, 0]},
        {"frame": 8, "position": [9, 0, 4], "target": [0, 0, 0], "sun": [90, 50, 0], "step": true},
        {"frame": 9, "position": [10, 0, 4], "target": [0, 0, 0]}]})");
    EXPECT_NEAR(positionOf(cameraAt(keys.camera, 3.0, {})).x, 3.0, 1e-6);  // straight: the jump bends nothing
    EXPECT_NEAR(positionOf(cameraAt(keys.camera, 7.9, {})).x, 4.0, 1e-6);
    EXPECT_NEAR(positionOf(cameraAt(keys.camera, 8.0, {})).x, 9.0, 1e-5);
    EXPECT_NEAR(positionOf(cameraAt(keys.camera, 8.5, {})).x, 9.5, 1e-5);
    EXPECT_EQ(sunAt(keys.sun, 7.9, {}).lux, 100);
    EXPECT_EQ(sunAt(keys.sun, 8.0, {}).lux, 0);
    EXPECT_EQ(sunAt(keys.sun, 8.0, {}).azimuthDeg, 90);
}

TEST(KeyFramesOf, SunsMoveLinearlyAndTakeWhatTheyLackFromTheStart) {
    const raster::Sun start{1, 2, 300, {1, 0.5, 0.25}};
    const KeyFrames given =
        keysOf(R"({"keys": [{"frame": 2, "sun": [350, 10, 100]}, {"frame": 6, "sun": [370, 30, 200]}]})");
    EXPECT_TRUE(given.camera.empty());
    const raster::Sun sun = sunAt(given.sun, 3.0, start);
    EXPECT_EQ(sun.azimuthDeg, 355);
    EXPECT_EQ(sun.elevationDeg, 15);
    EXPECT_EQ(sun.lux, 125);
    EXPECT_EQ(sun.color, start.color);
    EXPECT_EQ(sunAt(given.sun, 0.0, start).azimuthDeg, 350);
    EXPECT_EQ(sunAt(given.sun, 50.0, start).azimuthDeg, 370);
    EXPECT_EQ(sunAt(keysOf(R"({"keys": [{"frame": 2, "sun": [350, 10]}]})").sun, 3.0, start).lux, 300);
}

TEST(KeyFramesOf, ACameraThatMeetsItsTargetIsRefused) {
    const KeyFrames keys = keysOf(R"({"keys": [
        {"frame": 0, "position": [0, 0, 2], "target": [0, 0, 0]},
        {"frame": 2, "position": [0, 0, 0], "target": [0, 0, 2]}]})");
    EXPECT_THAT(test::thrown<InputError>([&] { cameraAt(keys.camera, 1.0, {}); }), HasSubstr("at frame 1 the camera"));
    // Straight up and down there is no up by +y, and yet a camera.
    const KeyFrames down = keysOf(R"({"keys": [{"frame": 0, "position": [0, 5, 0], "target": [0, 0, 0]}]})");
    const glm::mat3 view(cameraAt(down.camera, 0.0, {}).viewFromWorld);
    EXPECT_NEAR(glm::determinant(view), 1.0f, kRounding);
    EXPECT_LT(glm::length(view * glm::vec3(0, -1, 0) - glm::vec3(0, 0, -1)), kRounding);
}

TEST(KeyFramesOf, WrongFilesAreRefusedWithThePlace) {
    const std::pair<const char*, const char*> wrong[] = {
        {"{", "is no JSON"},
        {R"({"keys": [{"frame": 1e999, "sun": [0, 0]}]})", "is no JSON"},
        {"[]", "expected an object, found array"},
        {"{}", "needs a list \"keys\""},
        {R"({"keys": []})", "needs a list \"keys\""},
        {R"({"keys": [3]})", "keys[0]: expected an object"},
        {R"({"kyes": []})", "unknown key \"kyes\""},
        {R"({"keys": [{"frame": 0, "sun": [0, 0], "sunn": 1}]})", "keys[0]: unknown key \"sunn\""},
        {R"({"keys": [{"sun": [0, 0]}]})", "keys[0]: needs either a \"frame\" or a \"time\""},
        {R"({"keys": [{"frame": 0, "time": 0, "sun": [0, 0]}]})", "needs either"},
        {R"({"keys": [{"frame": -1, "sun": [0, 0]}]})", "keys[0]: frame: -1 is not in"},
        {R"({"keys": [{"frame": "0", "sun": [0, 0]}]})", "keys[0]: frame: expected a number, found string"},
        {R"({"keys": [{"frame": 0}]})", "keys[0]: holds neither"},
        {R"({"keys": [{"frame": 3, "sun": [0, 0]}, {"time": 0.1, "sun": [0, 0]}]})", "keys[1]: is not later"},
        {R"({"keys": [{"frame": 0, "sun": [0]}]})", "keys[0]: sun: expected 2 or 3 numbers, found 1"},
        {R"({"keys": [{"frame": 0, "sun": [0, 91]}]})", "keys[0]: sun: 91 is not in"},
        {R"({"keys": [{"frame": 0, "sun": [0, 0, -1]}]})", "keys[0]: sun: -1 is not in"},
        {R"({"keys": [{"frame": 0, "sun": [0, 0, 1]}, {"frame": 1, "sun": [0, 0]}]})", "keys[1]: all suns"},
        {R"({"keys": [{"frame": 0, "sun": [0, 0], "step": 1}]})", "\"step\" must be true or false"},
        {R"({"keys": [{"frame": 0, "target": [0, 0, 0]}]})", "keys[0]: a camera needs a \"position\""},
        {R"({"keys": [{"frame": 0, "fov": 40, "sun": [0, 0]}]})", "keys[0]: a camera needs a \"position\""},
        {R"({"keys": [{"frame": 0, "position": [0, 0, 0]}]})", "either a \"target\" or a \"rotation\""},
        {R"({"keys": [{"frame": 0, "position": [0, 0, 0], "target": [0, 0, 0]}]})", "stands on its target"},
        {R"({"keys": [{"frame": 0, "position": [0, 0], "target": [0, 0, 0]}]})", "position: expected 3 numbers"},
        {R"({"keys": [{"frame": 0, "position": [0, 0, 1e30], "target": [0, 0, 0]}]})", "position[2]: "},
        {R"({"keys": [{"frame": 0, "position": [0, 0, 0], "rotation": [0, 0, 0, 2]}]})", "rotation: is no rotation"},
        {R"({"keys": [{"frame": 0, "position": [0, 0, 0], "rotation": [0, 0, 0, 1], "fov": 180}]})", "fov: 180"},
        {R"({"keys": [{"frame": 0, "position": [0, 0, 1], "target": [0, 0, 0]},
                      {"frame": 1, "position": [0, 0, 1], "rotation": [0, 0, 0, 1]}]})",
         "keys[1]: all cameras must have a \"target\""},
        {R"({"keys": [{"frame": 0, "position": [0, 0, 1], "target": [0, 0, 0]},
                      {"frame": 1, "position": [0, 0, 1], "target": [0, 0, 0], "fov": 40}]})",
         "keys[1]: all cameras must have a \"fov\""},
    };
    for (const auto& [json, message] : wrong)
        EXPECT_THAT(test::thrown<InputError>([&] { keysOf(json); }), HasSubstr(message)) << json;
    EXPECT_THROW(readKeyFrames("missing.json", kFps), InputError);
}

}  // namespace
}  // namespace earthshine::cli
