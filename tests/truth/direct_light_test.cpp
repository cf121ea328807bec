// Direct light in closed form: a beam on slopes, a spot's inverse square, cone and range.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference/device_variants.hpp"
#include "truth/truth_scene.hpp"

namespace earthshine::truth {
namespace {

constexpr double kBar = 1e-3;  // 32-bit arithmetic, and a normal of 11 bits in the G-buffer

class DirectLight : public testing::TestWithParam<reference::Variant> {
protected:
    // At the origin of a level plate that faces up.
    double atOrigin(const Light& light, Output output = Output::DirectIrradiance, double albedo = 0.5) {
        raster::Scene scene;
        addRectangle(scene, {{-2, 0, 2}, {4, 0, 0}, {0, 0, -4}}, albedo);
        const FrameImages frame = DrawnScene(scene).draw(pointView({0, 0, 0}, {0, 1, 0}), {4, 4}, light, 64);
        return meanOf(compute(pipeline_, frame, fullSum(), output));
    }

    Pipeline pipeline_{Device(GetParam().caps, GetParam().options)};
};

TEST_P(DirectLight, ABeamGivesItsCosine) {
    const double lux = 1000.0;
    for (const double slopeDeg : {0.0, 30.0, 80.0}) {
        const double slope = slopeDeg * std::numbers::pi / 180.0;
        const glm::dvec3 u(1, 0, 0), v(0.0, std::sin(slope), -std::cos(slope));
        const std::string what = "slope_" + std::to_string(int(slopeDeg));
        const Light light = beamOnto({-0.5 * (u + v), u, v}, lux, 6.0);
        expectTruth(what, atOrigin(light), lux * std::cos(slope), kBar);
        // L = albedo / pi E.
        expectTruth(what + "_radiance", atOrigin(light, Output::Direct, 0.25),
                    0.25 / std::numbers::pi * lux * std::cos(slope), kBar);
    }
}

TEST_P(DirectLight, ASpotGivesInverseSquareConeAndRange) {
    const double candela = 500.0;
    for (const double distance : {0.5, 2.0, 4.0}) {
        const glm::dvec3 position(0.6 * distance, 0.8 * distance, 0.0);  // cosine 0.8
        const double onAxis = candela * 0.8 / (distance * distance);
        const std::string what = "distance_" + std::to_string(distance);
        expectTruth(what, atOrigin(spot(position, {0, 0, 0}, candela, 0.3, 0.8, 1.8)), onAxis, kBar);
        // 0.4 rad beside the axis: the cone's falloff is ((cos 0.4 - cos 0.8) / (cos 0.1 - cos 0.8))^2.
        const double c = std::cos(0.4), s = std::sin(0.4);
        const glm::dvec3 axis(-0.6 * c + 0.8 * s, -0.8 * c - 0.6 * s, 0.0);
        Light aside = spot(position, position + axis, candela, 0.1, 0.8, 1.8);
        const double t = (std::cos(0.4) - std::cos(0.8)) / (std::cos(0.1) - std::cos(0.8));
        expectTruth(what + "_aside", atOrigin(aside), onAxis * t * t, kBar);
        aside.rangeM = 5.0f;
        expectTruth(what + "_range", atOrigin(aside), onAxis * t * t * (1.0 - std::pow(distance / 5.0, 4)), kBar);
    }
}

INSTANTIATE_TEST_SUITE_P(All, DirectLight, testing::ValuesIn(reference::defaultVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine::truth
