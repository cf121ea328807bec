// What rays meet: sides, masks, mirrored placements, textures, light.

#include "raster/trace/trace_scene.hpp"

#include <memory>
#include <numbers>

#include <gmock/gmock.h>

#include "raster/trace/light_source.hpp"
#include "raster/trace/sampled_texture.hpp"
#include "raster/trace/sobol.hpp"
#include "trace/trace_support.hpp"

namespace earthshine::trace::test {
namespace {

using raster::Material;
using raster::Scene;

Material twoSided(Material material) {
    material.doubleSided = true;
    return material;
}

const Ray kFromFront{{0.1f, 0.2f, 3.0f}, {0, 0, -1}};
const Ray kFromBehind{{0.1f, 0.2f, -3.0f}, {0, 0, 1}};

TEST(TraceScene, SingleSidedSurfacesAreThereForWhoSeesTheirFront) {
    const Scene from = quadScene(diffuse(glm::vec3(0.5f)));
    const TraceScene scene(from);
    Hit hit;
    ASSERT_TRUE(scene.closest(kFromFront, hit));
    EXPECT_EQ(hit.t, 3.0f);
    EXPECT_FALSE(scene.closest(kFromBehind, hit));
    // A ray towards the light runs against it: light at +z meets the front.
    EXPECT_TRUE(scene.blocksLight(kFromBehind));
    EXPECT_FALSE(scene.blocksLight(kFromFront));
    std::vector<Hit> hits;
    scene.allHits(kFromBehind, hits);
    EXPECT_EQ(hits.size(), 1u);
    Surface surface = scene.surface(kFromBehind, hits[0]);
    EXPECT_EQ(surface.geometricNormal, glm::vec3(0, 0, 1));
    EXPECT_FALSE(surface.turnTowards({0, 0, -1}));
}

TEST(TraceScene, DoubleSidedSurfacesTurn) {
    const Scene from = quadScene(twoSided(diffuse(glm::vec3(0.5f))));
    const TraceScene scene(from);
    Hit hit;
    ASSERT_TRUE(scene.closest(kFromBehind, hit));
    EXPECT_TRUE(scene.blocksLight(kFromFront));
    EXPECT_TRUE(scene.blocksLight(kFromBehind));
    Surface surface = scene.surface(kFromBehind, hit);
    scene.shade(hit, surface);
    EXPECT_EQ(surface.normal, glm::vec3(0, 0, 1));
    EXPECT_TRUE(surface.turnTowards(-kFromBehind.direction));
    EXPECT_EQ(surface.normal, glm::vec3(0, 0, -1));
    scene.shade(hit, surface);
    EXPECT_EQ(surface.geometricNormal, glm::vec3(0, 0, -1));
    EXPECT_EQ(surface.normal, glm::vec3(0, 0, -1));
    EXPECT_LT(surface.leave({0, 0, -1}).z, surface.position.z);
    EXPECT_GT(surface.leave({0, 0, 1}).z, surface.position.z);
}

TEST(TraceScene, MirroredPlacementsKeepTheirFront) {
    Scene from = quadScene(diffuse(glm::vec3(0.5f)), glm::scale(glm::mat4(1), glm::vec3(-1, 2, 1)));
    const TraceScene scene(from);
    Hit hit;
    ASSERT_TRUE(scene.closest(kFromFront, hit));
    EXPECT_FALSE(scene.closest(kFromBehind, hit));
    ASSERT_TRUE(scene.closest(kFromFront, hit));
    Surface surface = scene.surface(kFromFront, hit);
    scene.shade(hit, surface);
    EXPECT_EQ(surface.normal, glm::vec3(0, 0, 1));
}

TEST(TraceScene, MasksCutHoles) {
    Material material = diffuse(glm::vec3(0.5f));
    material.alphaMode = raster::AlphaMode::Mask;
    material.baseColorTexture.texture = 0;
    Scene from = quadScene(material);
    // The left half is a hole; its colour would be red.
    from.textures = {nearestTexture(2, 1, {255, 0, 0, 0, 0, 255, 0, 255})};
    const TraceScene scene(from);
    Hit hit;
    const Ray left{{-0.5f, 0.1f, 3.0f}, {0, 0, -1}}, right{{0.5f, 0.1f, 3.0f}, {0, 0, -1}};
    EXPECT_FALSE(scene.closest(left, hit));
    ASSERT_TRUE(scene.closest(right, hit));
    Surface surface = scene.surface(right, hit);
    scene.shade(hit, surface);
    EXPECT_EQ(surface.albedo, glm::vec3(0.0f, 0.5f, 0.0f));
    EXPECT_FALSE(scene.blocksLight({{-0.5f, 0.1f, -3.0f}, {0, 0, 1}}));
    EXPECT_TRUE(scene.blocksLight({{0.5f, 0.1f, -3.0f}, {0, 0, 1}}));
    std::vector<Hit> hits;
    scene.allHits(left, hits);
    EXPECT_TRUE(hits.empty());
}

TEST(TraceScene, AllHitsFindsEverySheetOnce) {
    Scene from = quadScene(diffuse(glm::vec3(0.5f)));
    from.materials.push_back(twoSided(diffuse(glm::vec3(0.25f))));
    from.meshes.push_back(unitQuad(1, 3));
    for (int i = 1; i < 6; ++i) from.instances.push_back({i % 2, glm::translate(glm::mat4(1), glm::vec3(0, 0, -i))});
    raster::computeBounds(from);
    const TraceScene scene(from);
    std::vector<Hit> hits;
    scene.allHits({{0.1f, 0.2f, 0.1f}, {0, 0, 1}}, hits);  // from the middle: sheets at 0.5, 1.5 and 2.5
    EXPECT_EQ(hits.size(), 3u);
    for (const Hit& hit : hits) EXPECT_GT(hit.t, 0.0f);
}

TEST(TraceScene, ManyRaysAtOnceFindWhatEachFindsAlone) {
    // Masks, both kinds of sides; sizes about those that Embree takes together.
    const Scene from = dataScene("atrium.glb");
    const TraceScene scene(from);
    for (const std::uint32_t count : {0u, 1u, 15u, 64u, 65u, 1000u}) {
        std::vector<Ray> rays;
        for (std::uint32_t i = 0; i < count; ++i) {
            Sampler sampler(count, i);
            const glm::vec2 a = sampler.next2() - 0.5f, b = sampler.next2() - 0.5f, c = sampler.next2() - 0.5f;
            rays.push_back({{10.0f * a.x, 4.0f * a.y, 20.0f * b.x}, {b.y, c.x, c.y}});
        }
        std::vector<Hit> hits(count);
        const auto blocked = std::make_unique<bool[]>(count);
        scene.closest(rays, hits);
        scene.blocksLight(rays, {blocked.get(), count});
        for (std::uint32_t i = 0; i < count; ++i) {
            Hit hit;
            EXPECT_EQ(hits[i].isFound(), scene.closest(rays[i], hit)) << i << " of " << count;
            EXPECT_EQ(blocked[i], scene.blocksLight(rays[i])) << i << " of " << count;
            if (!hits[i].isFound()) continue;
            EXPECT_EQ(hits[i].t, hit.t) << i << " of " << count;
        }
    }
}

TEST(TraceScene, OffsetsClearTheSurfaceWhereverItIs) {
    Sampler sampler(7, 0);
    int met = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        Sampler s(7, i);
        const glm::vec2 a = s.next2(), b = s.next2(), c = s.next2();
        const glm::mat4 place =
            glm::scale(glm::rotate(glm::translate(glm::mat4(1), glm::vec3(30.0f * a.x, 20.0f * a.y, -50.0f * b.x)),
                                   6.0f * b.y, glm::normalize(glm::vec3(c.x - 0.5f, c.y - 0.5f, 0.3f))),
                       glm::vec3(0.01f + 40.0f * c.x));
        Scene from = quadScene(twoSided(diffuse(glm::vec3(0.5f))), place);
        from.instances.push_back({0, glm::translate(glm::mat4(1), glm::vec3(100, 100, 100))});  // moves the middle
        raster::computeBounds(from);
        if (i % 100 != 0) continue;  // building is slow: one scene for a hundred rays
        const TraceScene scene(from);
        const glm::vec3 normal = glm::normalize(glm::vec3(place[2]));
        for (std::uint32_t k = 0; k < 100; ++k) {
            Sampler inner(11 + i, k);
            const glm::vec2 at = inner.next2() * 1.8f - 0.9f, tilt = inner.next2() * 2.0f - 1.0f;
            const glm::vec3 target = glm::vec3(glm::dvec3(place * glm::vec4(at, 0.0f, 1.0f)) - scene.originWs());
            Hit hit;
            const Ray ray{target + 3.0f * normal, -normal};
            if (!scene.closest(ray, hit)) continue;
            ++met;
            Surface surface = scene.surface(ray, hit);
            surface.turnTowards(normal);
            // Grazing directions are the hard ones.
            const glm::vec3 direction = glm::normalize(glm::vec3(place * glm::vec4(tilt, 0.0f, 0.0f))) + 1e-3f * normal;
            EXPECT_FALSE(scene.blocksLight({surface.leave(direction), direction})) << i << " " << k;
            EXPECT_TRUE(scene.blocksLight({surface.leave(direction) + 0.01f * normal, -normal}));
        }
    }
    EXPECT_GT(met, 1900);
}

TEST(SampledTexture, FiltersAndWrapsAsGlDoes) {
    raster::Texture texture = nearestTexture(2, 2, {0, 0, 0, 255, 100, 0, 0, 255, 200, 0, 0, 255, 40, 0, 0, 55});
    texture.linearFilter = true;
    const SampledTexture repeated(texture);
    const auto red = [](const SampledTexture& t, float u, float v) { return t.sample({u, v}).r * 255.0f; };
    EXPECT_NEAR(red(repeated, 0.25f, 0.25f), 0.0f, 1e-3f);
    EXPECT_NEAR(red(repeated, 0.75f, 0.25f), 100.0f, 1e-3f);
    EXPECT_NEAR(red(repeated, 0.25f, 0.75f), 200.0f, 1e-3f);  // v runs down
    EXPECT_NEAR(red(repeated, 0.5f, 0.5f), 85.0f, 1e-3f);
    EXPECT_NEAR(red(repeated, 1.0f, 0.25f), 50.0f, 1e-3f);  // half of the other side
    EXPECT_NEAR(red(repeated, -7.25f, 5.25f), 100.0f, 1e-3f);
    EXPECT_NEAR(repeated.sample({0.75f, 0.75f}).a, 55.0f / 255.0f, 1e-6f);
    texture.wrapU = texture.wrapV = raster::Wrap::ClampToEdge;
    EXPECT_NEAR(red(SampledTexture(texture), 1.0f, 0.25f), 100.0f, 1e-3f);
    EXPECT_NEAR(red(SampledTexture(texture), -3.0f, 9.0f), 200.0f, 1e-3f);
    texture.wrapU = raster::Wrap::MirroredRepeat;
    EXPECT_NEAR(red(SampledTexture(texture), 1.25f, 0.0f), 100.0f, 1e-3f);
    EXPECT_NEAR(red(SampledTexture(texture), 1.75f, 0.0f), 0.0f, 1e-3f);
    texture.linearFilter = false;
    EXPECT_NEAR(red(SampledTexture(texture), 0.45f, 0.6f), 200.0f, 1e-3f);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e38f})
        EXPECT_TRUE(std::isfinite(red(repeated, bad, 0.5f)));
}

TEST(SampledTexture, MipmapsAreMeansOfLinearLight) {
    raster::Texture texture = nearestTexture(2, 2, {0, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0, 255});
    texture.linearFilter = texture.mipmaps = texture.isSrgb = true;
    const SampledTexture sampled(texture);
    // Two of four are white; stored as 8 bits sRGB: 188 of 255 is 0.503.
    EXPECT_NEAR(sampled.sample({0.3f, 0.6f}, {1, 0}, {0, 1}).r, 0.5f, 0.005f);
    EXPECT_NEAR(sampled.sample({0.75f, 0.25f}, {0.1f, 0}, {0, 0.1f}).r, 1.0f, 1e-6f);
    // A footprint of sqrt(2) texels: half of each level.
    EXPECT_NEAR(sampled.sample({0.75f, 0.25f}, {0.70710678f, 0}, {0, 0}).r, 0.75f, 0.005f);
    raster::Texture odd = nearestTexture(5, 3, std::vector<std::uint8_t>(60, 77));
    odd.mipmaps = odd.linearFilter = true;
    EXPECT_NEAR(SampledTexture(odd).sample({0.1f, 0.9f}, {2, 0}, {0, 2}).g, 77.0f / 255.0f, 1e-6f);
}

TEST(LightSource, SpotRaysAreAsDenseAsTheSpotIsBright) {
    const Light light = spotLight(glm::vec3(10.0f), {0, 2, 0}, {0, 0, 0}, 0.3f, 0.9f, 5.0);
    const LightSource source(light, {1, 0, 0});
    // The mean of f(cos) over rays that are distributed as f is the integral of f^2 over that of f: by quadrature here.
    double f1 = 0.0, f2 = 0.0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
        const double f = double(spotAttenuation(light, float(1.0 - (i + 0.5) / kSteps)));
        f1 += f / kSteps;
        f2 += f * f / kSteps;
    }
    EXPECT_NEAR(double(source.power()), 10.0 * 2.0 * std::numbers::pi * f1, 1e-4 * double(source.power()));
    double mean = 0.0;
    constexpr int kRays = 4096;
    for (std::uint32_t i = 0; i < kRays; ++i) {
        Sampler sampler(3, i);
        Ray ray;
        ASSERT_TRUE(source.sampleRay(sampler.next2(), ray));
        const glm::vec3 onFloor = ray.origin + ray.direction * ((0.0f - ray.origin.y) / ray.direction.y);
        const Incident incident = source.incident(onFloor);
        mean += double(spotAttenuation(light, incident.direction.y)) / kRays;
        // Density and light agree at every point: illuminance = I F x rays per area across the beam.
        const float density = source.raysPerArea(onFloor, {0, 1, 0});
        EXPECT_NEAR(incident.illuminance.x * incident.direction.y / (density * source.power()), 1.0f, 1e-4f);
    }
    EXPECT_NEAR(mean, f2 / f1, 2e-3);
    EXPECT_EQ(source.raysPerArea({-1.0f, 3.0f, 0.0f}, {0, 1, 0}), 0.0f) << "behind the light";
}

TEST(LightSource, DirectionalRaysCoverTheMapEvenly) {
    const Light light = directionalLight(glm::vec3(7.0f), orthographicCamera({0, 5, 0}, {0, 0, 0.001}, 2.0, 10.0));
    const LightSource source(light, {0, 0, 0});
    EXPECT_NEAR(source.power(), 7.0f * 16.0f, 1e-3f);
    EXPECT_NEAR(source.raysPerArea({0.3f, 0.0f, 1.5f}, {0, 1, 0}), 1.0f / 16.0f, 1e-6f);
    EXPECT_EQ(source.raysPerArea({0.3f, 0.0f, 2.5f}, {0, 1, 0}), 0.0f) << "beyond the map";
    EXPECT_EQ(source.incident({0.3f, 0.0f, 2.5f}).illuminance, glm::vec3(7.0f));
}

TEST(Sampler, PointsAreEvenAndIndependentOfEachOther) {
    // Any 2^k points of a (0, 2)-sequence: one in each cell of every grid of 2^k cells.
    for (const std::uint32_t sequence : {0u, 1u, 77777u}) {
        for (const int columns : {1, 4, 16, 64}) {
            std::vector<int> cells(64, 0);
            for (std::uint32_t i = 0; i < 64; ++i) {
                const glm::vec2 p = Sampler(sequence, i).next2();
                ++cells[std::size_t(int(p.x * float(columns)) + columns * int(p.y * float(64 / columns)))];
            }
            EXPECT_THAT(cells, ::testing::Each(1)) << sequence << " " << columns;
        }
    }
    // Two decisions of a sample, and two sequences, have no correlation: 1 / sqrt(4096) is one deviation.
    double decisions = 0.0, sequences = 0.0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        Sampler a(5, i), b(6, i);
        const float first = a.next2().x;
        decisions += 12.0 / 4096.0 * (double(first) - 0.5) * (double(a.next2().x) - 0.5);
        sequences += 12.0 / 4096.0 * (double(first) - 0.5) * (double(b.next2().x) - 0.5);
    }
    EXPECT_NEAR(decisions, 0.0, 0.06);
    EXPECT_NEAR(sequences, 0.0, 0.06);
}

}  // namespace
}  // namespace earthshine::trace::test
