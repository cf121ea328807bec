// A minified map is the same emitter: irradiance does not change, on average over the texels that its seeds pick.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "reference/device_variants.hpp"
#include "truth/truth_scene.hpp"

namespace earthshine::truth {
namespace {

class Minify : public testing::Test {
protected:
    double meanOver(int frameCount, const FrameImages& frame, Settings settings, int minify) {
        settings.rsmMinify = minify;
        settings.animatesNoise = true;  // another seed each frame
        double sum = 0.0;
        for (int i = 0; i < frameCount; ++i) sum += meanOf(compute(pipeline_, frame, settings));
        return sum / frameCount;
    }

    reference::Variant variant_ = reference::defaultVariants().at(0);
    Pipeline pipeline_{Device(variant_.caps, variant_.options)};
};

TEST_F(Minify, PlatesReceiveTheSame) {
    const Rectangle emitter{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
    const Rectangle above{{0, 1, -1}, {1, 0, 0}, {0, 0, 1}}, beside{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    for (const Rectangle& receiver : {above, beside}) {
        raster::Scene scene;
        addRectangle(scene, emitter, 0.5);
        addRectangle(scene, receiver, 1.0);
        DrawnScene drawn(scene);
        // Maps whose side 8 does not divide, with a dark border or none.
        for (const double side : {1.0, 1.3}) {
            const FrameImages frame = drawn.draw(squareView(receiver), {32, 32}, beamOnto(emitter, 1000.0, side), 509);
            const double whole = meanOver(1, frame, fullSum(), 1);
            for (const int minify : {2, 4, 8}) {
                const std::string what = fmt::format(
                    "{}_{}m_by_{}", receiver.normal().y < -0.5 ? "parallel" : "perpendicular", side, minify);
                expectTruth(what, meanOver(8, frame, fullSum(), minify), whole, 0.01);
                expectTruth(what + "_disk", meanOver(8, frame, wholeDisk(1024), minify), whole, 0.01);
            }
        }
    }
}

// Corners and edges: blocks lie across walls, and any mean of their normals would lose light.
TEST_F(Minify, AClosedRoomLosesNothing) {
    const double albedo = 0.7, candela = 200.0;
    const glm::dvec3 size(1.0, 0.8, 1.3), x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), o(0.0);
    const std::vector<Rectangle> walls{{o, z, x}, {o, y, z}, {o, x, y}, {size, -x, -z}, {size, -z, -y}, {size, -y, -x}};
    raster::Scene scene;
    for (const Rectangle& wall : walls) addRectangle(scene, wall, albedo);
    DrawnScene drawn(scene);
    const Light light = spot({0.6, 0.5, 0.9}, {0.1, 0.0, 0.2}, candela, 0.3, 0.9, 1.9);
    const double phi = albedo * candela * coneIntegral(light);
    for (const int minify : {1, 2, 4, 8}) {
        double arrived = 0.0;
        for (const Rectangle& wall : walls)
            arrived += wall.area() * meanOver(4, drawn.draw(squareView(wall), {24, 24}, light, 512), fullSum(), minify);
        // By 8 the discs are those of a map of 64 texels: along the room's edges, where a disc stands for texels that
        // touch the receiver, 1.5 % stay out.
        expectTruth(fmt::format("arrived_by_{}", minify), arrived, phi, minify == 8 ? 0.02 : 0.01);
    }
}

}  // namespace
}  // namespace earthshine::truth
