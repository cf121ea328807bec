// Form factors of rectangles through the whole path: a beam of E lux lights an emitter of albedo rho squarely, through
// the back of whatever stands before it; what receives from it must get rho E F.

#include <gtest/gtest.h>

#include "raster/light_fit.hpp"
#include "raster/scene/gltf_loader.hpp"
#include "reference/device_variants.hpp"
#include "truth/truth_scene.hpp"

namespace earthshine::truth {
namespace {

constexpr double kBar = 0.01;  // the project's promise; what is measured is 5 to 20 times better (tests/README.md)
constexpr double kAlbedo = 0.5, kLux = 1000.0;
constexpr int kRsmSizePx = 128;
constexpr Extent kReceiverPx{16, 16};

const Rectangle kEmitter{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};  // level, faces up
const Rectangle kAbove{{0, 1, -1}, {1, 0, 0}, {0, 0, 1}};    // parallel at distance 1, faces down
const Rectangle kBeside{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};   // shares the edge x = 0, faces +x

class Plates : public testing::TestWithParam<reference::Variant> {
protected:
    // Irradiance over `view`, a part of the receiver, over what the emitter gives off.
    double formFactor(const Rectangle& receiver, const Camera& view, const Settings& settings = fullSum()) {
        raster::Scene scene;
        addRectangle(scene, kEmitter, kAlbedo);
        addRectangle(scene, receiver, 1.0);
        const FrameImages frame = DrawnScene(scene).draw(view, kReceiverPx, beamOnto(kEmitter, kLux, 1.0), kRsmSizePx);
        return meanOf(compute(pipeline_, frame, settings)) / (kAlbedo * kLux);
    }

    Pipeline pipeline_{Device(GetParam().caps, GetParam().options)};
};

TEST_P(Plates, ParallelUnitSquares) {
    expectTruth("sum", formFactor(kAbove, squareView(kAbove)), 0.199825, kBar);
    expectTruth("disk", formFactor(kAbove, squareView(kAbove), wholeDisk(1024)), 0.199825, kBar);
}

TEST_P(Plates, UnitSquaresWithACommonEdge) {
    expectTruth("sum", formFactor(kBeside, squareView(kBeside)), 0.200044, kBar);
}

TEST_P(Plates, PointUnderTheCornerOfAParallelSquare) {
    // The receiver reaches beyond the corner, so that the point is inside it.
    const Rectangle wide{{-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}};
    const Camera view = pointView({0, 1, 0}, wide.normal());
    expectTruth("sum", formFactor(wide, view), 0.138532, kBar);
    expectTruth("disk", formFactor(wide, view, wholeDisk(4096)), 0.138532, kBar);
}

TEST_P(Plates, PointAcrossTheEndOfACommonEdge) {
    const Rectangle tall{{0, 0, 0.5}, {0, 0, -1}, {0, 1.5, 0}};
    const Camera view = pointView({0, 1, 0}, tall.normal());
    expectTruth("sum", formFactor(tall, view), 0.055734, kBar);
    expectTruth("disk", formFactor(tall, view, wholeDisk(4096)), 0.055734, kBar);
}

// A surface sends light only from the side that the light sees, and receives only on the side that the camera sees.
TEST_P(Plates, NothingReachesABack) {
    const Rectangle facingAway{{1.5, 1, 0}, {1, 0, 0}, {0, 0, -1}};
    EXPECT_EQ(formFactor(facingAway, squareView(facingAway)), 0.0);
    EXPECT_EQ(formFactor(facingAway, squareView(facingAway), wholeDisk(1024)), 0.0);
    const Rectangle below{{0, -1, 0}, {1, 0, 0}, {0, 0, -1}};  // lit by the emitter's back, if by anything
    EXPECT_EQ(formFactor(below, squareView(below)), 0.0);
    EXPECT_EQ(formFactor(below, squareView(below), wholeDisk(1024)), 0.0);
}

std::vector<reference::Variant> withNaivePorts() {
    std::vector<reference::Variant> variants;
    for (reference::Variant v : reference::defaultVariants()) {
        variants.push_back(v);
        v.options.lanes = 1;
        v.options.storage = v.caps.images ? "image" : "planar";
        v.options.rsmRecords = 0;
        v.name += "_naive";
        variants.push_back(v);
    }
    return variants;
}

INSTANTIATE_TEST_SUITE_P(All, Plates, testing::ValuesIn(withNaivePorts()),
                         [](const auto& variant) { return variant.param.name; });

// The scene of data/README.md with its own sun, one map over all of it: 40 000 lx at 60 degrees on albedo 0.5.
TEST(PlatesScene, ReceiversGetWhatTheReadmeSays) {
    const raster::Scene scene = raster::loadGltf(EARTHSHINE_DATA_DIR "/plates.glb");
    const reference::Variant variant = reference::defaultVariants().at(0);
    Pipeline pipeline{Device(variant.caps, variant.options)};
    DrawnScene drawn(scene);
    const Light sun = raster::fitLights(scene).at(0);
    const auto mean = [&](const Rectangle& r, Output output, int rsmSizePx) {
        return meanOf(compute(pipeline, drawn.draw(squareView(r), kReceiverPx, sun, rsmSizePx), fullSum(), output));
    };
    const Rectangle parallel{{-2.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}};
    const Rectangle perpendicular{{1.5, 1, 0.5}, {0, 0, -1}, {0, 1, 0}};
    // 1024 texels over 5 m: an edge is met to half a texel, 1/400 of a plate's side in each direction.
    expectTruth("parallel", mean(parallel, Output::IndirectIrradiance, 1024), 1998.25, kBar);
    expectTruth("perpendicular", mean(perpendicular, Output::IndirectIrradiance, 1024), 2000.44, kBar);
    const Rectangle emitter{{-2.5, 0, 0.5}, {1, 0, 0}, {0, 0, -1}};
    expectTruth("direct", mean(emitter, Output::DirectIrradiance, 64), 20000.0, 1e-4);
}

}  // namespace
}  // namespace earthshine::truth
