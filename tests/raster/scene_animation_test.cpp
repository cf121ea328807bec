// Animations: values over time against closed forms, what they move, and files that are wrong.

#include <cmath>
#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "earthshine/error.hpp"
#include "raster/scene/animator.hpp"
#include "raster/scene_support.hpp"

namespace earthshine::raster::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kRounding = 1e-6;  // of keys that are floats near 1

/// x, y, z, w of a turn about an axis of unit length.
glm::vec4 turn(double degrees, const glm::dvec3& axis) {
    const glm::dquat q = glm::angleAxis(glm::radians(degrees), axis);
    return {q.x, q.y, q.z, q.w};
}

void expectNear(const glm::dvec4& a, const glm::dvec4& b, double tolerance = kRounding) {
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

void expectNear(const glm::vec3& a, const glm::vec3& b) {
    expectNear(glm::dvec4(a, 0), glm::dvec4(b, 0), 4 * kRounding);
}

glm::vec3 at(const glm::mat4& matrix, const glm::vec3& point) {
    return glm::vec3(matrix * glm::vec4(point, 1.0f));
}

/// One channel of an animation of its own; its index in animations[].
int animate(GltfBuilder& b, int node, const char* path, const std::vector<float>& times,
            const std::vector<float>& values, const char* type, const char* interpolation = nullptr) {
    Json sampler = {{"input", b.accessor(times, "SCALAR")}, {"output", b.accessor(values, type)}};
    if (interpolation) sampler["interpolation"] = interpolation;
    Json channel = {{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}};
    return b.add("animations",
                 {{"channels", Json::array({std::move(channel)})}, {"samplers", Json::array({std::move(sampler)})}});
}

/// The quad with its node moved from x = 0 at 1 s to x = 8 at 3 s.
GltfBuilder movedQuad() {
    GltfBuilder builder = quadBuilder();
    animate(builder, 0, "translation", {1, 3}, {0, 0, 0, 8, 0, 0}, "VEC3");
    return builder;
}

TEST(AnimationValues, LinearGoesStraightAndStaysAtItsEnds) {
    const AnimationChannel channel{
        0, AnimatedPart::Translation, Interpolation::Linear, {1, 3, 4}, {{0, 2, 0, 0}, {8, 4, 0, 0}, {8, 0, 0, 0}}};
    expectNear(valueAt(channel, 0.0), {0, 2, 0, 0});
    expectNear(valueAt(channel, 1.0), {0, 2, 0, 0});
    expectNear(valueAt(channel, 1.5), {2, 2.5, 0, 0});
    expectNear(valueAt(channel, 3.0), {8, 4, 0, 0});
    expectNear(valueAt(channel, 3.25), {8, 3, 0, 0});
    expectNear(valueAt(channel, 100.0), {8, 0, 0, 0});
}

TEST(AnimationValues, StepHoldsUntilTheNextKey) {
    const AnimationChannel channel{0, AnimatedPart::Scale, Interpolation::Step, {0, 1}, {{1, 1, 1, 0}, {2, 2, 2, 0}}};
    expectNear(valueAt(channel, 0.999999), {1, 1, 1, 0});
    expectNear(valueAt(channel, 1.0), {2, 2, 2, 0});
}

TEST(AnimationValues, LinearRotationsTurnAtConstantSpeed) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -2));
    const AnimationChannel channel{
        0, AnimatedPart::Rotation, Interpolation::Linear, {0, 2}, {turn(20, axis), turn(150, axis)}};
    // Slerp about one axis is that axis at an angle that grows linearly; 130 degrees are the shorter way.
    for (const double t : {0.0, 0.3, 1.0, 1.7, 2.0})
        expectNear(valueAt(channel, t), glm::dvec4(turn(20 + 65 * t, axis)));
}

TEST(AnimationValues, LinearRotationsTakeTheShorterWay) {
    const glm::dvec3 y(0, 1, 0);
    // The same rotation with the other sign, and 200 degrees on, which is 160 degrees back.
    const AnimationChannel channel{
        0, AnimatedPart::Rotation, Interpolation::Linear, {0, 1, 2}, {turn(0, y), -turn(60, y), turn(260, y)}};
    const auto angleDeg = [&](double t) {
        const glm::dvec4 q = valueAt(channel, t);
        return glm::degrees(2.0 * std::atan2(q.y, q.w));
    };
    EXPECT_NEAR(std::remainder(angleDeg(0.5) - 30, 360), 0.0, 1e-4);
    EXPECT_NEAR(std::remainder(angleDeg(1.5) - (-20), 360), 0.0, 1e-4);
}

TEST(AnimationValues, CubicSplinesAreTheCubicOfTheirTangents) {
    // x(t) = t^3 - 2 t^2 + 3 t + 1 and its slopes at 1, 2 and 4 s: Hermite's interpolation is exact for cubics.
    const auto x = [](double t) { return ((t - 2) * t + 3) * t + 1; };
    const auto slope = [](double t) { return (3 * t - 4) * t + 3; };
    AnimationChannel channel{0, AnimatedPart::Translation, Interpolation::CubicSpline, {1, 2, 4}, {}};
    for (const double t : {1.0, 2.0, 4.0})
        for (const double value : {slope(t), x(t), slope(t)}) channel.values.emplace_back(float(value), 0, 0, 0);
    for (const double t : {1.0, 1.25, 1.9, 2.0, 2.5, 3.7, 4.0}) EXPECT_NEAR(valueAt(channel, t).x, x(t), 1e-12) << t;
    EXPECT_EQ(valueAt(channel, 0.0).x, x(1.0));
    EXPECT_EQ(valueAt(channel, 9.0).x, x(4.0));
}

TEST(AnimationValues, InAndOutTangentsDiffer) {
    // A corner at 1 s: up to it flat (in 0), from it on slope 3 (out 3), then 0 at the end. Hermite's basis by hand.
    const AnimationChannel channel{0,
                                   AnimatedPart::Translation,
                                   Interpolation::CubicSpline,
                                   {0, 1, 3},
                                   {{9, 0, 0, 0},
                                    {0, 0, 0, 0},
                                    {0, 0, 0, 0},
                                    {0, 0, 0, 0},
                                    {0, 0, 0, 0},
                                    {3, 0, 0, 0},
                                    {0, 0, 0, 0},
                                    {0, 0, 0, 0},
                                    {9, 0, 0, 0}}};
    EXPECT_EQ(valueAt(channel, 0.5).x, 0.0);
    EXPECT_NEAR(valueAt(channel, 2.0).x, 2 * 3 * 0.125, 1e-12);  // span x tangent x (t^3 - 2 t^2 + t at 1/2)
}

TEST(AnimationValues, CubicRotationsAreUnit) {
    const glm::vec4 still(0);
    const AnimationChannel channel{0,
                                   AnimatedPart::Rotation,
                                   Interpolation::CubicSpline,
                                   {0, 1},
                                   {still, turn(0, {0, 0, 1}), still, still, turn(90, {0, 0, 1}), still}};
    for (const double t : {0.0, 0.25, 0.5, 1.0}) EXPECT_NEAR(glm::length(valueAt(channel, t)), 1.0, 1e-12);
    expectNear(valueAt(channel, 0.5), glm::dvec4(turn(45, {0, 0, 1})));  // by symmetry
}

TEST(SceneAnimations, MoveInstancesDownTheTree) {
    GltfBuilder builder = quadBuilder();
    builder.document["nodes"][0]["translation"] = {0, 1, 0};
    const int parent = builder.add("nodes", {{"children", {0}}, {"scale", {2, 2, 2}}});
    const int still = builder.add("nodes", {{"mesh", 0}, {"translation", {0.1, 0.7, -3}}});
    const float half = float(std::numbers::sqrt2 / 2);
    animate(builder, parent, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, half, half}, "VEC4");
    Scene scene = builder.load();
    ASSERT_EQ(scene.instances.size(), 2u);
    const glm::mat4 before = scene.instances[1].worldFromObject;
    const Animator animator(scene, "");
    EXPECT_THAT(animator.movedInstances(), ElementsAre(0));
    EXPECT_EQ(animator.lastKeyS(), 1.0);
    animator.pose(scene, 1.0);
    // (1, 0, 0): moved (1, 1, 0), scaled (2, 2, 0), turned by 90 degrees about z (-2, 2, 0).
    expectNear(at(scene.instances[0].worldFromObject, {1, 0, 0}), {-2, 2, 0});
    EXPECT_EQ(scene.instances[1].worldFromObject, before);
    EXPECT_FALSE(animator.moves(still));
}

TEST(SceneAnimations, AtRestNothingChangesItsBits) {
    GltfBuilder builder = quadBuilder();
    const std::vector<float> place = {0.1f, 0.7f, -3};
    builder.document["nodes"][0]["translation"] = place;
    builder.document["nodes"][0]["rotation"] = {0.1, 0.2, 0.3, 0.9};
    animate(builder, 0, "translation", {0, 1}, {place[0], place[1], place[2], 5, 5, 5}, "VEC3");
    Scene scene = builder.load();
    const glm::mat4 loaded = scene.instances[0].worldFromObject;
    Animator(scene, "").pose(scene, 0.0);
    EXPECT_EQ(scene.instances[0].worldFromObject, loaded);
}

TEST(SceneAnimations, MoveCamerasAndLights) {
    GltfBuilder builder;
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.25}}}});
    const int light = builder.addLight({{"type", "directional"}});
    builder.add("nodes", {{"camera", 0}, {"scale", {2, 2, 2}}});
    builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    builder.add("nodes", {{"children", {0, 1}}});
    const float half = float(std::numbers::sqrt2 / 2);
    animate(builder, 2, "rotation", {0, 2}, {0, 0, 0, 1, 0, half, 0, half}, "VEC4");
    Scene scene = builder.load();
    Animator(scene, "0").pose(scene, 2.0);
    // A quarter turn about y takes -z to -x.
    expectNear(-glm::vec3(scene.cameras.at(0).worldFromView[2]), {-1, 0, 0});
    EXPECT_NEAR(glm::determinant(scene.cameras.at(0).worldFromView), 1.0f, 1e-6f);
    expectNear(-glm::vec3(scene.lights.at(0).worldFromLight[2]), {-1, 0, 0});
}

TEST(SceneAnimations, ALightWithoutDirectionStaysWhereItWas) {
    GltfBuilder builder;
    const int light = builder.addLight({{"type", "directional"}});
    builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}, {"translation", {1, 2, 3}}});
    animate(builder, 0, "scale", {0, 1}, {1, 1, 1, 0, 0, 0}, "VEC3");
    Scene scene = builder.load();
    Animator(scene, "").pose(scene, 1.0);
    EXPECT_EQ(glm::vec3(scene.lights.at(0).worldFromLight[3]), glm::vec3(1, 2, 3));
}

TEST(SceneAnimations, AreFoundByNameOrNumberAndPlayedTogether) {
    GltfBuilder builder = movedQuad();
    builder.document["animations"][0]["name"] = "slide";
    builder.document["animations"][animate(builder, 0, "scale", {0, 1}, {1, 1, 1, 3, 3, 3}, "VEC3")]["name"] = "grow";
    const auto placed = [&](const char* which) {
        Scene scene = builder.load();
        Animator(scene, which).pose(scene, 4.0);
        return at(scene.instances.at(0).worldFromObject, {1, 0, 0});
    };
    expectNear(placed("slide"), {9, 0, 0});
    expectNear(placed("1"), {3, 0, 0});
    expectNear(placed(""), {11, 0, 0});
    const Scene scene = builder.load();
    try {
        Animator(scene, "walk");
        ADD_FAILURE();
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("no animation \"walk\"; there is 0 \"slide\", 1 \"grow\""));
    }
    EXPECT_THROW(Animator(scene, "2"), UsageError);
    EXPECT_THROW(Animator(quadBuilder().load(), ""), UsageError);
}

TEST(SceneAnimations, SweptBoundsHoldEveryFrame) {
    Scene scene = movedQuad().load();
    const Animator animator(scene, "");
    const std::vector<WorldBox> boxes = animator.sweptBounds(scene, 30.0);
    ASSERT_EQ(boxes.size(), 1u);
    // The quad's [-1; 1] moved by 0 to 8 m, and a millionth more.
    EXPECT_NEAR(boxes[0].min.x, -1.0f, 1e-5f);
    EXPECT_NEAR(boxes[0].max.x, 9.0f, 1e-5f);
    EXPECT_NEAR(boxes[0].max.y, 1.0f, 1e-5f);
    for (int frame = 0; frame < 100; ++frame) {
        animator.pose(scene, frame / 30.0);
        EXPECT_GE(at(scene.instances[0].worldFromObject, {-1, 0, 0}).x, boxes[0].min.x);
        EXPECT_LE(at(scene.instances[0].worldFromObject, {1, 0, 0}).x, boxes[0].max.x);
    }
}

TEST(SceneAnimations, OfHoursAreSweptInFewSteps) {
    GltfBuilder builder = quadBuilder();
    animate(builder, 0, "translation", {0, 1e9f}, {0, 0, 0, 8, 0, 0}, "VEC3");
    Scene scene = builder.load();
    EXPECT_NEAR(Animator(scene, "").sweptBounds(scene, 1000.0).at(0).max.x, 9.0f, 1e-5f);
}

TEST(SceneAnimations, BeyondFloatsAreAnInputError) {
    GltfBuilder builder = quadBuilder();
    builder.add("nodes", {{"children", {0}}, {"scale", {1e30, 1e30, 1e30}}});
    animate(builder, 0, "translation", {0, 1}, {0, 0, 0, 3e30f, 0, 0}, "VEC3");
    Scene scene = builder.load();
    EXPECT_THROW(Animator(scene, "").pose(scene, 1.0), InputError);
}

TEST(SceneAnimations, NormalizedRotationsAreRead) {
    GltfBuilder builder = quadBuilder();
    const Json sampler = {{"input", builder.accessor(std::vector<float>{0}, "SCALAR")},
                          {"output", builder.accessor(std::vector<std::int16_t>{0, 0, 23170, 23170}, "VEC4", true)}};
    builder.add("animations",
                {{"channels", Json::array({Json{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}})},
                 {"samplers", Json::array({sampler})}});
    Scene scene = builder.load();
    Animator(scene, "").pose(scene, 0.0);
    expectNear(at(scene.instances[0].worldFromObject, {1, 0, 0}), {0, 1, 0});
}

TEST(SceneAnimations, WhatIsNotPlayedIsNoted) {
    GltfBuilder builder = movedQuad();
    Json& channels = builder.document["animations"][0]["channels"];
    channels.push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}});
    channels.push_back({{"sampler", 0}, {"target", {{"path", "pointer"}}}});
    const Scene scene = builder.load();
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("morph weights"), HasSubstr("\"pointer\"")));
    EXPECT_EQ(scene.animations.at(0).channels.size(), 1u);
}

TEST(SceneAnimations, OfNodesOutsideTheSceneAreLeftOut) {
    GltfBuilder builder = movedQuad();
    builder.add("nodes", {{"mesh", 0}});
    builder.document["scenes"] = Json::array({Json{{"nodes", {1}}}});
    EXPECT_THAT(builder.load().animations, IsEmpty());
}

/// One way to spoil the moved quad, and words of the line that must come of it.
struct Spoiled {
    const char* name;
    std::function<void(GltfBuilder&)> spoil;
    const char* place;
    const char* what;
};

void PrintTo(const Spoiled& spoiled, std::ostream* out) {
    *out << spoiled.name;
}

Json& channel(GltfBuilder& b) {
    return b.document["animations"][0]["channels"][0];
}
Json& sampler(GltfBuilder& b) {
    return b.document["animations"][0]["samplers"][0];
}

const Spoiled kSpoiled[] = {
    {"ChannelsMissing", [](GltfBuilder& b) { b.document["animations"][0].erase("channels"); }, "animations[0].channels",
     "missing"},
    {"ChannelsEmpty", [](GltfBuilder& b) { b.document["animations"][0]["channels"] = Json::array(); },
     "animations[0].channels", "0 elements"},
    {"SamplersWrongType", [](GltfBuilder& b) { b.document["animations"][0]["samplers"] = 3; }, "animations[0].samplers",
     "not an array"},
    {"SamplerUnknown", [](GltfBuilder& b) { channel(b)["sampler"] = 1; }, "animations[0].channels[0].sampler",
     "is 1, but samplers has 1"},
    {"SamplerNegative", [](GltfBuilder& b) { channel(b)["sampler"] = -1; }, "animations[0].channels[0].sampler", "-1"},
    {"TargetMissing", [](GltfBuilder& b) { channel(b).erase("target"); }, "animations[0].channels[0].target",
     "missing"},
    {"PathMissing", [](GltfBuilder& b) { channel(b)["target"].erase("path"); }, "channels[0].target.path", "missing"},
    {"PathNumber", [](GltfBuilder& b) { channel(b)["target"]["path"] = 1; }, "channels[0].target.path", "not a string"},
    {"NodeUnknown", [](GltfBuilder& b) { channel(b)["target"]["node"] = 7; }, "channels[0].target.node", "nodes has 1"},
    {"NodeWithMatrix",
     [](GltfBuilder& b) { b.document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     "animations[0].channels[0]", "has a matrix"},
    {"TargetTwice", [](GltfBuilder& b) { b.document["animations"][0]["channels"].push_back(channel(b)); },
     "animations[0].channels[1]", "a second time"},
    {"InputUnknown", [](GltfBuilder& b) { sampler(b)["input"] = 99; }, "animations[0].samplers[0].input", "99"},
    {"InputNoScalar", [](GltfBuilder& b) { sampler(b)["input"] = 0; }, "animations[0].samplers[0].input",
     "times are SCALAR"},
    {"InputIntegers", [](GltfBuilder& b) { sampler(b)["input"] = 3; }, "animations[0].samplers[0].input",
     "times are SCALAR"},
    {"InputBackwards",
     [](GltfBuilder& b) {
         sampler(b)["input"] = b.accessor(std::vector<float>{3, 1}, "SCALAR");
     },
     "animations[0].samplers[0].input[1]", "is 1; times"},
    {"InputTwice",
     [](GltfBuilder& b) {
         sampler(b)["input"] = b.accessor(std::vector<float>{1, 1}, "SCALAR");
     },
     "animations[0].samplers[0].input[1]", "after the one before"},
    {"InputNegative",
     [](GltfBuilder& b) {
         sampler(b)["input"] = b.accessor(std::vector<float>{-1, 1}, "SCALAR");
     },
     "animations[0].samplers[0].input[0]", "is -1"},
    {"InputNan",
     [](GltfBuilder& b) {
         sampler(b)["input"] = b.accessor(std::vector<float>{0, NAN}, "SCALAR");
     },
     "animations[0].samplers[0].input[1]", "not finite"},
    {"OutputNan",
     [](GltfBuilder& b) {
         sampler(b)["output"] = b.accessor(std::vector<float>{0, 0, 0, 0, INFINITY, 0}, "VEC3");
     },
     "animations[0].samplers[0].output[1]", "not finite"},
    {"OutputTooShort",
     [](GltfBuilder& b) {
         sampler(b)["output"] = b.accessor(std::vector<float>{0, 0, 0}, "VEC3");
     },
     "animations[0].samplers[0].output", "1 elements, 2 keys need 2"},
    {"OutputWrongType", [](GltfBuilder& b) { sampler(b)["output"] = 2; }, "animations[0].samplers[0].output",
     "which a translation or scale cannot be"},
    {"RotationOfThree", [](GltfBuilder& b) { channel(b)["target"]["path"] = "rotation"; },
     "animations[0].samplers[0].output", "which a rotation cannot be"},
    {"RotationZero",
     [](GltfBuilder& b) {
         channel(b)["target"]["path"] = "rotation";
         sampler(b)["output"] = b.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
     },
     "animations[0].samplers[0].output[1]", "no rotation"},
    {"InterpolationUnknown", [](GltfBuilder& b) { sampler(b)["interpolation"] = "SMOOTH"; },
     "animations[0].samplers[0].interpolation", "SMOOTH"},
    {"SplineWithoutTangents", [](GltfBuilder& b) { sampler(b)["interpolation"] = "CUBICSPLINE"; },
     "animations[0].samplers[0].output", "2 keys need 6"},
    {"SplineOfOneKey",
     [](GltfBuilder& b) {
         sampler(b)["interpolation"] = "CUBICSPLINE";
         sampler(b)["input"] = b.accessor(std::vector<float>{1}, "SCALAR");
     },
     "animations[0].samplers[0].input", "needs two"},
};

class AnimationRefusal : public testing::TestWithParam<Spoiled> {};

TEST_P(AnimationRefusal, InOneLineWithThePlace) {
    GltfBuilder builder = movedQuad();
    GetParam().spoil(builder);
    const std::string message = refusalOf(builder);
    EXPECT_THAT(message, HasSubstr(GetParam().place));
    EXPECT_THAT(message, HasSubstr(GetParam().what));
}

INSTANTIATE_TEST_SUITE_P(Of, AnimationRefusal, testing::ValuesIn(kSpoiled),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(AnimationRefusalOfBombs, KeysWithoutEnd) {
    // A sampler of a million zeros that four hundred channels read.
    GltfBuilder builder = movedQuad();
    const int times = builder.accessor(std::vector<float>(1u << 20u), "SCALAR");
    builder.document["accessors"][times].erase("bufferView");
    const int values = builder.addAccessor(-1, 5126, 1u << 20u, "VEC3");
    Json animation = {{"channels", Json::array()},
                      {"samplers", Json::array({Json{{"input", times}, {"output", values}}})}};
    animation["channels"].push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}});
    builder.document["animations"] = Json::array();
    for (int i = 0; i < 400; ++i) builder.document["animations"].push_back(animation);
    EXPECT_THAT(refusalOf(builder), HasSubstr("animations[0].samplers[0].input[1]"));  // zeros do not increase
    std::vector<float> increasing(1u << 20u);
    for (std::size_t i = 0; i < increasing.size(); ++i) increasing[i] = float(i);
    for (Json& each : builder.document["animations"]) each["samplers"][0]["input"] = times + 2;
    ASSERT_EQ(builder.accessor(increasing, "SCALAR"), times + 2);
    EXPECT_THAT(refusalOf(builder), HasSubstr("animations[4].samplers[0]: the animations have more than 4194304 keys"));
}

}  // namespace
}  // namespace earthshine::raster::test
