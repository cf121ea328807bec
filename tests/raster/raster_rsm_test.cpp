// Reflective shadow maps: what a light sends out must arrive, no more and no less, at every resolution.

#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "raster/light_fit.hpp"
#include "raster/raster_support.hpp"

namespace earthshine::raster::test {
namespace {

const Camera kAnyCamera = lookAtCamera({0, 3, 9}, {0, 0, 0}, {1, 1});

glm::dvec3 totalFlux(const HostImage& flux, int firstRow, int rowCount) {
    glm::dvec3 total(0.0);
    for (int y = firstRow; y < firstRow + rowCount; ++y)
        for (int x = 0; x < flux.extent().widthPx; ++x) total += glm::dvec3(rgba(flux, x, y));
    return total;
}

void expectRatio(const glm::dvec3& value, const glm::dvec3& expected, double tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c] / expected[c], 1.0, tolerance) << "channel " << c;
}

// A level plate 4 m x 2 m under a sun: rho E A cos(angle to the vertical), whatever the map's resolution.
TEST(RasterRsm, FluxOfASunOverAPlateIsWhatFallsOnIt) {
    const glm::dvec3 albedo(0.8, 0.5, 0.2);
    Scene scene = quadScene(
        diffuse(glm::vec3(albedo)),
        glm::scale(glm::rotate(glm::mat4(1), -glm::half_pi<float>(), glm::vec3(1, 0, 0)), glm::vec3(2, 1, 1)));
    for (const float elevationDeg : {90.0f, 60.0f, 20.0f}) {
        for (const int sizePx : {16, 64, 512}) {
            const std::vector<Light> lights = fitLights(scene, {Sun{90.0f, elevationDeg, 1000.0f}});
            const HostFrame frame = drawScene(scene, kAnyCamera, {{1, 1}, sizePx, 1}, lights);
            const double sine = std::sin(glm::radians(double(elevationDeg)));
            SCOPED_TRACE(testing::Message() << elevationDeg << " degrees, " << sizePx << " px");
            // The fitted map is 1e-4 of a side larger all round, far below half a texel: every texel is a hit. 5e-4:
            // those margins, in area.
            expectRatio(totalFlux(frame.rsmFlux, 0, sizePx), albedo * 1000.0 * 8.0 * sine, 5e-4);
        }
    }
}

// A plate that only fills a part of the map, turned about: edges are sampled, so the error falls with the texel.
TEST(RasterRsm, FluxOfATurnedPlateConverges) {
    Scene scene = quadScene(
        diffuse(glm::vec3(0.5f)),
        glm::rotate(glm::rotate(glm::mat4(1), -glm::half_pi<float>(), glm::vec3(1, 0, 0)), 0.4f, glm::vec3(0, 0, 1)));
    const Light light = directionalLight(glm::vec3(1000), orthographicCamera({1, 4, 2}, {0, 0, 0}, 2.0, 10));
    const double cosine = 4.0 / std::sqrt(21.0);
    for (const int sizePx : {128, 256, 512, 1024}) {
        const HostFrame frame = drawScene(scene, kAnyCamera, {{1, 1}, sizePx, 1}, {light});
        SCOPED_TRACE(sizePx);
        expectRatio(totalFlux(frame.rsmFlux, 0, sizePx), glm::dvec3(0.5 * 1000.0 * 4.0 * cosine), 0.005);
    }
}

/// The integral of the cone's falloff over the solid angle, by the midpoint rule in cos(theta).
double coneIntegral(double innerAngle, double outerAngle) {
    const double cosInner = std::cos(innerAngle);
    const double cosOuter = std::cos(outerAngle);
    constexpr int kSteps = 100000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double cosine = cosOuter + (1.0 - cosOuter) * (i + 0.5) / kSteps;
        const double t = std::clamp((cosine - cosOuter) / std::max(cosInner - cosOuter, 1e-3), 0.0, 1.0);
        sum += t * t;
    }
    return 2.0 * std::numbers::pi * (1.0 - cosOuter) * sum / kSteps;
}

// In a closed box all of a spot's light arrives, wherever it stands and looks.
TEST(RasterRsm, FluxOfASpotInABoxIsAllItsLight) {
    Scene scene;
    scene.materials = {diffuse({0.7f, 0.5f, 0.3f})};
    scene.meshes = {unitBox(0, true)};
    scene.instances = {{0, glm::scale(glm::mat4(1), glm::vec3(3, 2, 4))}};
    struct Case {
        float inner, outer;
        glm::dvec3 position, target;
    };
    for (const Case& c : {Case{0.3f, 0.6f, {0, 1, 0}, {0, -1, 0}}, Case{0.0f, 0.9f, {2, -1, 3}, {-1, 0.5, 0}},
                          Case{0.1f, 1.3f, {0.1, 0.2, 0.3}, {1, 1, 1}}}) {
        const Light light = spotLight({100, 200, 300}, c.position, c.target, c.inner, c.outer, 20);
        const glm::dvec3 expected =
            glm::dvec3(0.7, 0.5, 0.3) * glm::dvec3(100, 200, 300) * coneIntegral(double(c.inner), double(c.outer));
        for (const int sizePx : {64, 128, 512}) {
            SCOPED_TRACE(testing::Message() << "outer " << c.outer << ", " << sizePx << " px");
            const HostFrame frame = drawScene(scene, kAnyCamera, {{1, 1}, sizePx, 1}, {light});
            expectRatio(totalFlux(frame.rsmFlux, 0, sizePx), expected, 0.005);
        }
    }
}

// Each texel for itself: depth, normal and power of a spot over a plane, in doubles from the texel's ray alone.
TEST(RasterRsm, EveryTexelOfASpotHasItsPower) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)),
                            glm::scale(glm::rotate(glm::mat4(1), -1.2f, glm::vec3(1, 0.1f, 0)), glm::vec3(50)));
    Light light = spotLight({10, 20, 30}, {0, 2, 1}, {0.2, 0, 0}, 0.2f, 0.7f, 40);
    light.rangeM = 4.0f;
    const int sizePx = 33;
    const Extent extent{sizePx, sizePx};
    const HostFrame frame = drawScene(scene, kAnyCamera, {{1, 1}, sizePx, 1}, {light});
    const glm::dmat4 viewFromObject =
        glm::dmat4(light.camera.viewFromWorld) * glm::dmat4(scene.instances[0].worldFromObject);
    const glm::dvec3 point(viewFromObject[3]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(viewFromObject[0]), glm::dvec3(viewFromObject[1]));
    const double halfSide = std::tan(0.7);
    const auto solidAngleAt = [&](double x, double y) {
        return std::pow(2.0 * halfSide / sizePx, 2) / std::pow(glm::length(pixelRayVs(light.camera, extent, x, y)), 3);
    };
    const auto depthAt = [&](double x, double y) {
        return glm::dot(point, normal) / glm::dot(pixelRayVs(light.camera, extent, x, y), normal);
    };
    const auto fluxAt = [&](double x, double y) {
        const double length = glm::length(pixelRayVs(light.camera, extent, x, y));
        const double t = std::clamp((1.0 / length - std::cos(0.7)) / (std::cos(0.2) - std::cos(0.7)), 0.0, 1.0);
        const double range = std::clamp(1.0 - std::pow(depthAt(x, y) * length / 4.0, 4), 0.0, 1.0);
        return 0.5 * 20.0 * solidAngleAt(x, y) * t * t * range;
    };
    const double shiftPx = subpixelShiftPx(sharedContext());
    int lit = 0;
    for (int y = 0; y < sizePx; ++y) {
        for (int x = 0; x < sizePx; ++x) {
            const Range depth = rangeAround(x, y, shiftPx, depthAt);
            EXPECT_LE(depth.misses(double(*frame.rsmDepth.pixel(x, y))), 1e-5 * depth.min) << x << ", " << y;
            const double flux = double(rgba(frame.rsmFlux, x, y).y);
            // Floats; the differences in t and in the range window cost digits where they are near 0.
            EXPECT_LE(rangeAround(x, y, shiftPx, fluxAt).misses(flux),
                      1e-5 * 0.5 * 20.0 * solidAngleAt(x + 0.5, y + 0.5))
                << x << ", " << y << ": " << flux << ", not " << fluxAt(x + 0.5, y + 0.5);
            lit += flux > 0.0;
        }
    }
    EXPECT_GT(lit, 100);
    EXPECT_LT(lit, sizePx * sizePx);  // the corners of the map lie outside the cone
}

TEST(RasterRsm, LightsStandBelowOneAnother) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    const std::vector<Light> lights = {directionalLight({1, 0, 0}, orthographicCamera({0, 0, 2}, {0, 0, 0}, 1.0, 10)),
                                       directionalLight({0, 1, 0}, orthographicCamera({0, 0, 3}, {0, 0, 0}, 1.0, 10)),
                                       spotLight({0, 0, 1}, {0, 0, 4}, {0, 0, 0}, 0.05f, 0.1f, 10)};
    const HostFrame frame = drawScene(scene, kAnyCamera, {{1, 1}, 4, 6}, lights);
    ASSERT_EQ(frame.rsmFlux.extent(), (Extent{4, 12}));
    ASSERT_EQ(frame.shadowDepth.extent(), (Extent{6, 18}));
    for (int light = 0; light < 3; ++light) {
        for (int i = 0; i < 16; ++i) EXPECT_EQ(*frame.rsmDepth.pixel(i % 4, 4 * light + i / 4), float(2 + light));
        for (int i = 0; i < 36; ++i) EXPECT_EQ(*frame.shadowDepth.pixel(i % 6, 6 * light + i / 6), float(2 + light));
        const glm::dvec3 flux = totalFlux(frame.rsmFlux, 4 * light, 4);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(flux[c] > 0.0, c == light);
    }
}

TEST(RasterRsm, OnlyFrontFacesReflect) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    const Light behind = directionalLight(glm::vec3(1), orthographicCamera({0, 0, -2}, {0, 0, 0}, 1.0, 10));
    const HostFrame culled = drawScene(scene, kAnyCamera, {{1, 1}, 3, 3}, {behind});
    EXPECT_EQ(rgba(culled.rsmFlux, 1, 1), glm::vec4(0));
    EXPECT_EQ(rgba(culled.rsmNormalWs, 1, 1), glm::vec4(0));
    EXPECT_EQ(*culled.rsmDepth.pixel(1, 1), 0.0f);
    EXPECT_EQ(*culled.shadowDepth.pixel(1, 1), 0.0f);
    scene.materials[0].doubleSided = true;
    const HostFrame seen = drawScene(scene, kAnyCamera, {{1, 1}, 3, 3}, {behind});
    EXPECT_EQ(rgba(seen.rsmNormalWs, 1, 1), glm::vec4(0, 0, -1, 1));
    EXPECT_EQ(*seen.rsmDepth.pixel(1, 1), 2.0f);
    EXPECT_EQ(*seen.shadowDepth.pixel(1, 1), 2.0f);
}

// A normal map that turns the surface away from the light shapes where the flux goes, and takes nothing from it.
TEST(RasterRsm, NormalMapsTakeNoFlux) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    const Light light = directionalLight(glm::vec3(1), orthographicCamera({0, 0, 2}, {0, 0, 0}, 1.0, 10));
    const HostFrame flat = drawScene(scene, kAnyCamera, {{1, 1}, 4, 1}, {light});
    scene.materials[0].normalTexture.texture = 0;
    scene.textures = {nearestTexture(1, 1, {250, 128, 100, 255})};  // beyond the horizon
    const HostFrame bumpy = drawScene(scene, kAnyCamera, {{1, 1}, 4, 1}, {light});
    EXPECT_LT(rgba(bumpy.rsmNormalWs, 1, 1).z, 0.0f);
    EXPECT_EQ(rgba(bumpy.rsmFlux, 1, 1), rgba(flat.rsmFlux, 1, 1));
    EXPECT_GT(rgba(flat.rsmFlux, 1, 1).x, 0.0f);
}

TEST(RasterRsm, ShadowMapAgreesWithTheRsm) {
    Scene scene;
    scene.materials = {diffuse(glm::vec3(0.5f))};
    scene.meshes = {unitBox(0)};
    scene.instances = {{0, glm::rotate(glm::mat4(1), 0.7f, glm::vec3(1, 2, 3))}};
    const std::vector<Light> lights = fitLights(scene, {Sun{30, 40, 1}});
    const HostFrame frame = drawScene(scene, kAnyCamera, {{1, 1}, 40, 40}, lights);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) EXPECT_EQ(*frame.rsmDepth.pixel(x, y), *frame.shadowDepth.pixel(x, y));
}

}  // namespace
}  // namespace earthshine::raster::test
