#include "reference/synthetic_frame.hpp"

#include <cmath>
#include <random>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace earthshine::reference {

namespace {

// std::mt19937 is the same everywhere; the standard's distributions are not.
class Random {
public:
    double uniform(double low, double high) { return low + (high - low) * double(engine_()) / 4294967296.0; }
    glm::vec3 direction() {
        while (true) {
            const glm::vec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
            const float length = glm::length(v);
            if (length > 0.1f && length < 1.0f) return v / length;
        }
    }

private:
    std::mt19937 engine_{20260229u};
};

Camera lookAt(glm::vec3 eye, glm::vec3 target, glm::mat4 clipFromView) {
    return {glm::lookAt(eye, target, glm::vec3(0.0f, 1.0f, 0.1f)), clipFromView};
}

void put(HostImage& image, int x, int y, glm::vec4 v) {
    float* p = image.pixel(x, y);
    for (int c = 0; c < channelCount(image.format()); ++c) p[c] = v[c];
}

}  // namespace

FrameImages makeSyntheticFrame(const SyntheticOptions& o) {
    Random random;
    FrameImages f;
    f.camera = lookAt({4.0f, 2.0f, 5.0f}, {0.0f, 0.5f, 0.0f},
                      glm::perspective(0.9f, float(o.extent.widthPx) / float(o.extent.heightPx), 0.1f, 50.0f));
    // An off-centre projection: nothing may assume that the axis meets the middle.
    f.camera.clipFromView[2][0] = 0.1f;
    f.camera.clipFromView[2][1] = -0.05f;

    HostImage albedo(PixelFormat::RGBA32F, o.extent), normal(PixelFormat::RGBA32F, o.extent);
    HostImage emission(PixelFormat::RGBA32F, o.extent), motion(PixelFormat::RGBA32F, o.extent);
    f.depth = HostImage(PixelFormat::R32F, o.extent);
    for (int y = 0; y < o.extent.heightPx; ++y) {
        for (int x = 0; x < o.extent.widthPx; ++x) {
            const bool isSky = random.uniform(0, 1) < o.skyFraction;
            put(emission, x, y, {random.uniform(0, 3), random.uniform(0, 3), random.uniform(0, 3), 1});
            const glm::vec3 n = random.direction();
            const glm::vec4 a(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1), 1);
            const auto depth = float(random.uniform(2.0, 9.0));
            if (isSky) continue;
            put(albedo, x, y, a);
            put(normal, x, y, glm::vec4(n, 1));
            put(f.depth, x, y, glm::vec4(depth));
        }
    }
    f.albedo = toHalf(albedo.view());
    f.normalWs = toHalf(normal.view());
    f.motion = toHalf(motion.view());
    if (o.emission) f.emission = toHalf(emission.view());

    const Extent rsm{o.rsmSizePx, o.rsmSizePx * o.lightCount};
    const Extent shadow{o.shadowExtent.widthPx, o.shadowExtent.heightPx * o.lightCount};
    f.rsmDepth = HostImage(PixelFormat::R32F, rsm);
    f.rsmFlux = HostImage(PixelFormat::RGBA32F, rsm);
    f.shadowDepth = HostImage(PixelFormat::R32F, shadow);
    HostImage rsmNormal(PixelFormat::RGBA32F, rsm);
    for (int i = 0; i < o.lightCount; ++i) {
        Light light;
        light.name = i % 2 == 0 ? "directional" : "spot";
        light.type = i % 2 == 0 ? LightType::Directional : LightType::Spot;
        light.intensity = glm::vec3(30.0f, 20.0f, 10.0f) * float(i + 1);
        light.innerConeAngle = 0.3f;
        light.outerConeAngle = 0.7f;
        light.indirectScale = i == 1 ? 2.5f : 1.0f;
        light.gatherRadiusUv = i == 2 ? 0.6f : 0.0f;
        light.rangeM = i == 1 ? 14.0f : 0.0f;
        const glm::vec3 eye = glm::vec3(-3.0f, 8.0f, 2.0f) + 2.0f * float(i) * random.direction();
        light.camera = lookAt(eye, glm::vec3(0.0f),
                              light.type == LightType::Directional ? glm::ortho(-5.0f, 6.0f, -4.0f, 5.0f, 0.1f, 30.0f)
                                                                   : glm::perspective(1.4f, 1.0f, 0.1f, 30.0f));
        f.lights.push_back(light);
        for (int y = 0; y < o.rsmSizePx; ++y) {
            for (int x = 0; x < o.rsmSizePx; ++x) {
                const int row = i * o.rsmSizePx + y;
                const glm::vec3 n = random.direction();
                const glm::vec4 flux(random.uniform(0, 2), random.uniform(0, 2), random.uniform(0, 2), 1);
                const auto depth = float(random.uniform(4.0, 12.0));
                if (random.uniform(0, 1) < 0.15) continue;
                put(f.rsmDepth, x, row, glm::vec4(depth));
                put(rsmNormal, x, row, glm::vec4(n, 1));
                put(f.rsmFlux, x, row, flux);
            }
        }
        for (int y = 0; y < o.shadowExtent.heightPx; ++y)
            for (int x = 0; x < o.shadowExtent.widthPx; ++x)
                if (random.uniform(0, 1) > 0.2)
                    put(f.shadowDepth, x, i * o.shadowExtent.heightPx + y, glm::vec4(float(random.uniform(3.0, 15.0))));
    }
    f.rsmNormalWs = toHalf(rsmNormal.view());
    return f;
}

}  // namespace earthshine::reference
