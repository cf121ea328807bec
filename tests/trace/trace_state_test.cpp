// Sums in a file: going on gives the very bits of never having stopped, and other people's files are refused.

#include <cstring>

#include <gmock/gmock.h>

#include "earthshine/error.hpp"
#include "image/temp_folder.hpp"
#include "raster/camera_fit.hpp"
#include "raster/light_fit.hpp"
#include "trace/trace_support.hpp"

namespace earthshine::trace::test {
namespace {

using earthshine::test::readText;
using earthshine::test::TempFolder;
using earthshine::test::thrown;
using earthshine::test::writeText;
using ::testing::HasSubstr;

class TraceState : public ::testing::Test {
protected:
    TempFolder folder;
    raster::Scene scene = dataScene("cornell.glb");
    TraceSettings settings{.extent = {9, 7}};
    std::vector<Light> lights = raster::fitLights(scene);

    PathTracer tracer() const {
        return PathTracer(scene, raster::cameraFor(scene, "", settings.extent), lights, settings);
    }
    std::string state() const { return (folder / "sums").string(); }
};

TEST_F(TraceState, GoesOnWhereItWasLeft) {
    PathTracer whole = tracer(), first = tracer(), second = tracer();
    whole.addSamples(12);
    first.addSamples(5);
    first.saveState(state());
    second.loadState(state());
    EXPECT_EQ(second.sampleCount(), 5);
    second.addSamples(7);
    const HostImage a = whole.read(Output::Color), b = second.read(Output::Color);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.sizeBytes()), 0);
    EXPECT_EQ(whole.noise().relMse, second.noise().relMse);
}

TEST_F(TraceState, RefusesWhatItWasNotMadeFor) {
    PathTracer first = tracer();
    first.addSamples(2);
    first.saveState(state());
    const auto refused = [&] { return thrown<InputError>([&] { tracer().loadState(state()); }); };
    const TraceSettings before = settings;
    settings.extent = {7, 9};
    EXPECT_THAT(refused(), HasSubstr("9x7"));
    settings = before;
    settings.seed = 3;
    EXPECT_THAT(refused(), HasSubstr("another scene"));
    settings = before;
    settings.bounceCount = 2;
    EXPECT_THAT(refused(), HasSubstr("another scene"));
    settings = before;
    lights[0].intensity.g += 1.0f;
    EXPECT_THAT(refused(), HasSubstr("another scene"));
    lights[0].intensity.g -= 1.0f;
    scene.meshes[0].vertices[0].position.x += 1e-6f;
    EXPECT_THAT(refused(), HasSubstr("another scene"));
    scene = dataScene("cornell.glb");
    scene.materials[1].baseColor.b += 0.01f;
    EXPECT_THAT(refused(), HasSubstr("another scene"));
    scene = dataScene("cornell.glb");
    tracer().loadState(state());
    settings.threads = 1;  // does not change the picture
    tracer().loadState(state());
}

TEST_F(TraceState, RefusesDamagedFiles) {
    PathTracer first = tracer();
    first.addSamples(2);
    first.saveState(state());
    const std::string good = readText(state());
    const auto refused = [&](const std::string& bytes) {
        writeText(state(), bytes);
        return thrown<InputError>([&] { tracer().loadState(state()); });
    };
    EXPECT_THAT(refused(""), HasSubstr("is not a state"));
    EXPECT_THAT(refused("earthshine trace 1\n"), HasSubstr("is not a state"));
    EXPECT_THAT(refused(good.substr(0, good.size() - 8)), HasSubstr("damaged"));
    EXPECT_THAT(refused(good + "x"), HasSubstr("damaged"));
    std::string flipped = good;
    flipped[good.size() / 2] = char(flipped[good.size() / 2] ^ 1);
    EXPECT_THAT(refused(flipped), HasSubstr("damaged"));
    std::filesystem::remove(state());
    EXPECT_THAT(thrown<InputError>([&] { tracer().loadState(state()); }), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace earthshine::trace::test
