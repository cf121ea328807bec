// The path tracer against closed forms, against itself estimated in other ways, and against its own word on its noise.

#include "raster/trace/path_tracer.hpp"

#include <cstring>

#include <gmock/gmock.h>

#include "earthshine/error.hpp"
#include "image/metrics.hpp"
#include "image/temp_folder.hpp"
#include "raster/camera_fit.hpp"
#include "raster/light_fit.hpp"
#include "trace/trace_support.hpp"

namespace earthshine::trace::test {
namespace {

using earthshine::test::thrown;
using ::testing::HasSubstr;

TraceSettings settingsFor(Extent extent, int bounces = 1) {
    TraceSettings settings;
    settings.extent = extent;
    settings.bounceCount = bounces;
    return settings;
}

bool sameBytes(const HostImage& a, const HostImage& b) {
    return a.extent() == b.extent() && std::memcmp(a.data(), b.data(), a.sizeBytes()) == 0;
}

// A camera whose pixels lie evenly over a unit square, close before it.
Camera overPlate(const glm::dvec3& centre, const glm::dvec3& normal) {
    return orthographicCamera(centre + 0.5 * normal, centre, 0.5, 1.0);
}

class Plates : public ::testing::TestWithParam<bool> {
protected:
    raster::Scene scene = dataScene("plates.glb");
    std::vector<Light> lights = raster::fitLights(scene);
    TraceSettings settings = settingsFor({32, 32});
    void SetUp() override { settings.indirectVisibility = GetParam(); }
};

// 0.5 %: what the truth is held to. 64 samples at 1024 pixels leave less than 0.1 % of noise in a mean; the midpoint
// rule over 32 x 32 pixels is off by less than 0.05 %.
TEST_P(Plates, ParallelPlatesHaveTheirFormFactor) {
    const auto tracer = traced(scene, overPlate({-2, 1, 0}, {0, -1, 0}), lights, settings, 64);
    EXPECT_EQ(tracer.surfacePixels(), 1024u);
    EXPECT_EQ(meanOf(tracer.read(Output::DirectIrradiance)), 0.0);
    EXPECT_NEAR(meanOf(tracer.read(Output::IndirectIrradiance)) / (10000.0 * 0.199825), 1.0, 0.005);
    EXPECT_NEAR(meanOf(tracer.read(Output::Indirect)) / (10000.0 * 0.199825 * 0.5 / 3.14159265358979), 1.0, 0.005);
}

TEST_P(Plates, PerpendicularPlatesHaveTheirFormFactor) {
    const auto tracer = traced(scene, overPlate({1.5, 1.5, 0}, {1, 0, 0}), lights, settings, 64);
    EXPECT_NEAR(meanOf(tracer.read(Output::IndirectIrradiance)) / (10000.0 * 0.200044), 1.0, 0.005);
}

TEST_P(Plates, EmittersGetTheSunAndNothingElse) {
    const auto tracer = traced(scene, overPlate({-2, 0, 0}, {0, 1, 0}), lights, settings, 2);
    // Float rounding of the light's direction.
    EXPECT_NEAR(rangeOf(tracer.read(Output::DirectIrradiance)).x, 20000.0, 0.1);
    EXPECT_NEAR(rangeOf(tracer.read(Output::DirectIrradiance)).y, 20000.0, 0.1);
    EXPECT_NEAR(meanOf(tracer.read(Output::Direct)), 20000.0 * 0.5 / 3.14159265358979, 0.02);
    EXPECT_EQ(meanOf(tracer.read(Output::IndirectIrradiance)), 0.0);
}

std::string visibilityName(const ::testing::TestParamInfo<bool>& info) {
    return info.param ? "Visible" : "Unoccluded";
}
INSTANTIATE_TEST_SUITE_P(, Plates, ::testing::Values(true, false), visibilityName);

TEST(Furnace, OneBounceIsTheSameEverywhere) {
    const Furnace f = furnace(0.5f, 2.0, {0, 0, 0}, {48, 32});
    const auto tracer = traced(f.scene, f.camera, f.lights, settingsFor({48, 32}), 256);
    EXPECT_EQ(tracer.surfacePixels(), 48u * 32u);
    // Noise of 1536 x 256 paths, of which 6 % hit light: 0.2 %; facets: 0.01 %.
    EXPECT_NEAR(meanOf(tracer.read(Output::IndirectIrradiance)) / f.firstBounceLux, 1.0, 0.005);
}

TEST(Furnace, LightSamplesAloneHaveNoNoiseInASphere) {
    const Furnace f = furnace(0.5f, 2.0, {0, 0, 0}, {48, 32}, 512);
    TraceSettings settings = settingsFor({48, 32});
    settings.indirectVisibility = false;
    settings.strategy = Strategy::FromLight;
    const auto tracer = traced(f.scene, f.camera, f.lights, settings, 16);
    EXPECT_NEAR(meanOf(tracer.read(Output::IndirectIrradiance)) / f.firstBounceLux, 1.0, 0.001);
    // Every sample is worth the same but for the facets' flatness, which matters where x is near y.
    EXPECT_LT(tracer.noise().relMse, 1e-4);
}

TEST(Furnace, BouncesAddUpToTheGeometricSeries) {
    const float albedo = 0.6f;
    const Furnace f = furnace(albedo, 2.0, {0, 0, 0}, {48, 32});
    // Second bounce, and all: each is the albedo times the one before.
    const auto two = traced(f.scene, f.camera, f.lights, settingsFor({48, 32}, 2), 128);
    EXPECT_NEAR(meanOf(two.read(Output::IndirectIrradiance)) / (f.firstBounceLux * 1.6), 1.0, 0.005);
    const auto all = traced(f.scene, f.camera, f.lights, settingsFor({48, 32}, kAllBounces), 128);
    // A path of all bounces has 2.5 lives; noise 0.3 %.
    EXPECT_NEAR(meanOf(all.read(Output::IndirectIrradiance)) / (f.firstBounceLux / (1.0 - 0.6)), 1.0, 0.01);
}

TEST(Furnace, SizeAndPlaceDoNotMatter) {
    // A closed sphere shows both kinds of slip: rays that start inside a wall (darker) and light that leaks (brighter).
    for (const auto& [radius, centre] : {std::pair(0.01, glm::dvec3(0)), std::pair(500.0, glm::dvec3(20000, 0, -7000)),
                                         std::pair(1.0, glm::dvec3(2000, 300, -1000))}) {
        const Furnace f = furnace(0.5f, radius, centre, {16, 16});
        const auto tracer = traced(f.scene, f.camera, f.lights, settingsFor({16, 16}), 512);
        EXPECT_EQ(tracer.surfacePixels(), 256u) << radius;
        // Noise 0.4 %; vertices 1000 m away are rounded to 0.1 mm, a ten-thousandth of a radius of 1 m.
        EXPECT_NEAR(meanOf(tracer.read(Output::IndirectIrradiance)) / f.firstBounceLux, 1.0, 0.01) << radius;
        // Everything is either outside the cone or lit as the cone says, without speckles of self-shadow: the centre of
        // the beam is full.
        EXPECT_NEAR(rangeOf(tracer.read(Output::DirectIrradiance)).y, 100.0 / (radius * radius),
                    0.002 * 100.0 / (radius * radius))
            << radius;
    }
}

TEST(Unoccluded, BothWaysOfEstimatingAgree) {
    const raster::Scene scene = dataScene("cornell.glb");
    const Extent extent{24, 24};
    const Camera camera = raster::cameraFor(scene, "", extent);
    const std::vector<Light> lights = raster::fitLights(scene);
    TraceSettings settings = settingsFor(extent);
    settings.indirectVisibility = false;
    const auto meanBy = [&](Strategy strategy, int samples) {
        settings.strategy = strategy;
        return meanOf(traced(scene, camera, lights, settings, samples).read(Output::IndirectIrradiance));
    };
    const double both = meanBy(Strategy::Both, 256);
    // Light samples alone are noisy near corners (1 / distance^2).
    EXPECT_NEAR(meanBy(Strategy::FromSurface, 256) / both, 1.0, 0.005);
    EXPECT_NEAR(meanBy(Strategy::FromLight, 2048) / both, 1.0, 0.015);
    // What stands between only takes light away.
    settings.indirectVisibility = true;
    EXPECT_LT(meanBy(Strategy::Both, 256), 0.95 * both);
}

TEST(Unoccluded, TwoLightsAreTheSumOfEach) {
    const raster::Scene scene = dataScene("cornell.glb");
    const Extent extent{16, 16};
    const Camera camera = raster::cameraFor(scene, "", extent);
    std::vector<Light> lights = raster::fitLights(scene);
    lights.push_back(raster::sunLight({180.0f, 30.0f, 300.0f}, scene));  // through the open front
    for (const bool visibility : {true, false}) {
        TraceSettings settings = settingsFor(extent);
        settings.indirectVisibility = visibility;
        const auto mean = [&](const std::vector<Light>& of) {
            return meanOf(traced(scene, camera, of, settings, 256).read(Output::IndirectIrradiance));
        };
        const double sum = mean({lights[0]}) + mean({lights[1]});
        EXPECT_GT(mean({lights[1]}), 0.1 * sum);
        EXPECT_NEAR(mean(lights) / sum, 1.0, 0.01) << visibility;  // noise
    }
}

TEST(PathTracer, IsTheSameOnAnyNumberOfThreadsAndInAnyPortions) {
    const raster::Scene scene = dataScene("cornell.glb");
    const Extent extent{17, 13};
    const Camera camera = raster::cameraFor(scene, "", extent);
    const std::vector<Light> lights = raster::fitLights(scene);
    for (const bool visibility : {true, false}) {
        TraceSettings settings = settingsFor(extent);
        settings.indirectVisibility = visibility;
        settings.threads = 1;
        const auto one = traced(scene, camera, lights, settings, 7);
        settings.threads = 3;
        auto other = traced(scene, camera, lights, settings, 2);
        other.addSamples(1);
        other.addSamples(4);
        EXPECT_TRUE(sameBytes(one.read(Output::Color), other.read(Output::Color)));
        settings.seed = 1;
        const auto third = traced(scene, camera, lights, settings, 7);
        EXPECT_FALSE(sameBytes(one.read(Output::Indirect), third.read(Output::Indirect)));
        EXPECT_TRUE(sameBytes(one.read(Output::Direct), third.read(Output::Direct)));
    }
}

TEST(PathTracer, KnowsItsNoise) {
    const raster::Scene scene = dataScene("cornell.glb");
    const Extent extent{64, 64};
    const Camera camera = raster::cameraFor(scene, "", extent);
    const std::vector<Light> lights = raster::fitLights(scene);
    auto truth = traced(scene, camera, lights, settingsFor(extent), 4096);
    TraceSettings settings = settingsFor(extent);
    settings.seed = 12345;
    const auto rough = traced(scene, camera, lights, settings, 127);  // halves of 64 and 63
    CompareOptions display;
    display.kind = PictureKind::Display;
    const PictureErrors errors =
        measureErrors(rough.read(Output::IndirectIrradiance).view(), truth.read(Output::IndirectIrradiance).view());
    // The estimate is a mean over 12 288 squares of which few are independent normals; points that are even in each
    // half are a little more even in both together.
    EXPECT_GT(rough.noise().relMse, 0.7 * errors.relMse);
    EXPECT_LT(rough.noise().relMse, 1.6 * errors.relMse);
    EXPECT_LT(std::abs(errors.meanError), 4.0 * rough.noise().meanError);
    EXPECT_LT(truth.noise().relMse, 0.05 * rough.noise().relMse);
}

TEST(PathTracer, OutputsFitTogether) {
    raster::Scene scene = dataScene("cornell.glb");
    scene.materials[0].emission = {3, 2, 1};
    const Extent extent{24, 16};  // wider than the box: sky at the sides
    const Camera camera = raster::cameraFor(scene, "", extent);
    TraceSettings settings = settingsFor(extent);
    settings.background = {5, 6, 7};
    const auto without = traced(scene, camera, raster::fitLights(scene), settings, 2);
    settings.emission = true;
    const auto with = traced(scene, camera, raster::fitLights(scene), settings, 2);
    EXPECT_LT(without.surfacePixels(), 24u * 16u);
    const HostImage color = with.read(Output::Color), direct = with.read(Output::Direct),
                    plain = without.read(Output::Direct), indirect = with.read(Output::Indirect),
                    albedo = with.albedo(), irradiance = with.read(Output::DirectIrradiance), depth = with.depth();
    int sky = 0, emitters = 0;
    for (int i = 0; i < 24 * 16; ++i) {
        const float* c = color.pixel(0, 0) + 4 * i;
        const float* d = direct.pixel(0, 0) + 4 * i;
        const float* p = plain.pixel(0, 0) + 4 * i;
        if (c[3] == 0.0f) {
            ++sky;
            EXPECT_EQ(glm::vec3(c[0], c[1], c[2]), settings.background);
            EXPECT_EQ(d[1], 6.0f);
            EXPECT_EQ(depth.pixel(0, 0)[i], 0.0f);
            EXPECT_EQ(indirect.pixel(0, 0)[4 * i], 0.0f);
            continue;
        }
        EXPECT_GT(depth.pixel(0, 0)[i], 0.0f);
        EXPECT_EQ(c[1], d[1] + indirect.pixel(0, 0)[4 * i + 1]);
        EXPECT_NEAR(p[0], albedo.pixel(0, 0)[4 * i] / 3.14159265f * irradiance.pixel(0, 0)[4 * i], 1e-3f);
        emitters += d[0] - p[0] > 2.999f;
    }
    EXPECT_GT(sky, 50);
    EXPECT_GT(emitters, 20);
}

TEST(PathTracer, NoBounceIsDirectLightAlone) {
    const raster::Scene scene = dataScene("cornell.glb");
    const Camera camera = raster::cameraFor(scene, "", {8, 8});
    const auto tracer = traced(scene, camera, raster::fitLights(scene), settingsFor({8, 8}, 0), 64);
    EXPECT_EQ(meanOf(tracer.read(Output::IndirectIrradiance)), 0.0);
    EXPECT_GT(meanOf(tracer.read(Output::DirectIrradiance)), 0.0);
    EXPECT_EQ(tracer.rays().gather, 0u);
    EXPECT_EQ(tracer.rays().camera, 64u);
}

TEST(PathTracer, EmptyScenesAreSky) {
    raster::Scene scene;
    scene.materials.emplace_back();
    const auto tracer = traced(scene, lookAtCamera({0, 0, 2}, {0, 0, 0}, {4, 4}), {}, settingsFor({4, 4}), 2);
    EXPECT_EQ(tracer.surfacePixels(), 0u);
    EXPECT_EQ(tracer.noise().relMse, 0.0);
    EXPECT_EQ(rgba(tracer.read(Output::Color), 1, 1), glm::vec4(0.0f));
}

TEST(PathTracer, RefusesSettingsWithoutMeaning) {
    const raster::Scene scene = dataScene("plates.glb");
    const Camera camera = raster::cameraFor(scene, "", {8, 8});
    const auto refused = [&](TraceSettings settings) {
        return thrown<UsageError>([&] { PathTracer(scene, camera, {}, settings); });
    };
    EXPECT_THAT(refused(settingsFor({0, 8})), HasSubstr("0x8"));
    EXPECT_THAT(refused(settingsFor({8, 8}, -2)), HasSubstr("-2 bounces"));
    TraceSettings settings = settingsFor({8, 8}, 2);
    settings.indirectVisibility = false;
    EXPECT_THAT(refused(settings), HasSubstr("one bounce"));
}

}  // namespace
}  // namespace earthshine::trace::test
