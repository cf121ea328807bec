// One texel stands for a small disc of its area on the surface, seen along the disc's axis: E = Phi / pi / (h^2 + r^2)
// on the axis of the texel at height h, and no more than M = Phi / (pi r^2) however close. This is what keeps a texel
// that touches a point from outshining all others, without a constant of the scene's scale (kernels/common/rsm.clh).

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>

#include "reference/device_variants.hpp"
#include "truth/truth_scene.hpp"

namespace earthshine::truth {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAlbedo = 0.5;
// A record keeps the radius in 11 bits and the normal in 16.
constexpr double kBar = 1e-3;

class Disc : public testing::TestWithParam<reference::Variant> {
protected:
    // Irradiance at height h over the origin of a wide level plate that faces up; the point looks down.
    double irradianceAt(double height, const Light& light, int rsmSizePx) {
        raster::Scene scene;
        addRectangle(scene, {{-5, 0, 5}, {10, 0, 0}, {0, 0, -10}}, kAlbedo);
        addRectangle(scene, {{-1, height, -1}, {2, 0, 0}, {0, 0, 2}}, 1.0);
        const FrameImages frame =
            DrawnScene(scene).draw(pointView({0, height, 0}, {0, -1, 0}), {2, 2}, light, rsmSizePx);
        return meanOf(compute(pipeline_, frame, fullSum()));
    }

    Pipeline pipeline_{Device(GetParam().caps, GetParam().options)};
};

TEST_P(Disc, OneTexelOfABeam) {
    const double side = 0.4, lux = 1000.0;
    for (const double slopeDeg : {0.0, 60.0}) {
        // The texel is `side` across the beam, and longer on the plate by the slope.
        const double slope = slopeDeg * kPi / 180.0;
        const glm::dvec3 v(0.0, std::sin(slope), -std::cos(slope)), u(1, 0, 0);
        const Light light = beamOnto({-0.5 * (u + v), u, v}, lux, side);
        const double phi = kAlbedo * lux * side * side;
        const double r2 = side * side / std::cos(slope) / kPi;
        for (const double height : {0.02, 0.2, 2.0})
            expectTruth("slope_" + std::to_string(int(slopeDeg)) + "_height_" + std::to_string(height),
                        irradianceAt(height, light, 1), phi / kPi / (height * height + r2), kBar);
    }
}

TEST_P(Disc, FourTexelsOfASpot) {
    // Texels t D wide on the plate, a quarter of the map's side off the axis.
    const double distance = 1.5, angle = 1.2, candela = 300.0, t = std::tan(angle / 2.0);
    const Light light = spot({0, distance, 0}, {0, 0, 0}, candela, 1.4, 1.5, angle);
    const double cosine = 1.0 / std::sqrt(1.0 + t * t / 2.0);
    const double phi = kAlbedo * candela * t * t * cosine * cosine * cosine;
    const double r2 = t * t * distance * distance / kPi;
    for (const double height : {0.2, 1.0}) {
        const double d2 = height * height + t * t * distance * distance / 2.0;
        expectTruth("height_" + std::to_string(height), irradianceAt(height, light, 2),
                    4.0 * phi / kPi * height * height / (d2 * (d2 + r2)), kBar);
    }
}

// By default and at 4 lanes: where the radius of a texel alone is lost, no other truth notices.
std::vector<reference::Variant> variants() {
    std::vector<reference::Variant> some;
    for (reference::Variant v : reference::defaultVariants()) {
        some.push_back(v);
        v.options.lanes = 4;
        v.name += "_lanes4";
        some.push_back(v);
    }
    return some;
}
INSTANTIATE_TEST_SUITE_P(All, Disc, testing::ValuesIn(variants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine::truth
