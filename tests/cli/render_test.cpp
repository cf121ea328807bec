// `earthshine render` and `earthshine indirect`, whole, on small pictures.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "earthshine/settings.hpp"
#include "image/image_file.hpp"
#include "image/temp_folder.hpp"

namespace fs = std::filesystem;

namespace earthshine {
namespace {

using test::Arguments;
using test::readText;
using test::Result;
using test::runEarthshine;
using test::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class Render : public ::testing::Test {
protected:
    /// The Cornell box at 64x36 with small maps, and what `more` asks for; fails the test if the program fails.
    Result render(const Arguments& more) {
        Arguments arguments{
            "render", EARTHSHINE_DATA_DIR "/cornell.glb", "--size", "64x36", "--rsm-size", "32", "--shadow-size", "64"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return succeed(arguments);
    }

    Result succeed(const Arguments& arguments) {
        const Result result = runEarthshine(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_EQ(test::besidesProgress(result.err), "");
        return result;
    }

    std::string path(const std::string& name) const { return (folder / name).string(); }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(readText(folder / name)); }
    HostImage layer(const std::string& file, const std::string& name) const {
        const std::vector<std::string> channels{name + "R", name + "G", name + "B"};
        return readExr(folder / file, channels, PixelFormat::RGBA32F);
    }

    /// Replaces the first `from` in a text file.
    void edit(const std::string& name, const std::string& from, const std::string& to) {
        std::string text = readText(folder / name);
        const auto at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from << " is not in\n" << text;
        test::writeText(folder / name, text.replace(at, from.size(), to));
    }

    TempFolder folder;
};

TEST_F(Render, WritesWhatWasAskedForAndNothingElse) {
    const Result result = render({"-o", path("a.exr"), "--aov", "all", "--sheet", path("sheet.png"), "--report",
                                  path("r.json"), "--save-inputs", path("in")});
    EXPECT_THAT(folder.names(),
                ElementsAre("a.exr", "a.png", "a.rsm.exr", "a.shadow.exr", "in", "r.json", "sheet.png"));
    for (const char* words : {"rsm_gather", "all stages", "median ms", "a.exr", "sheet.png"})
        EXPECT_THAT(result.out, HasSubstr(words));

    EXPECT_THAT(
        readExrHeader(folder / "a.exr").channels,
        UnorderedElementsAre("R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z",
                             "depth.Z", "motion.X", "motion.Y", "motion.Z", "emission.R", "emission.G", "emission.B",
                             "direct-irradiance.R", "direct-irradiance.G", "direct-irradiance.B",
                             "indirect-irradiance.R", "indirect-irradiance.G", "indirect-irradiance.B", "direct.R",
                             "direct.G", "direct.B", "indirect.R", "indirect.G", "indirect.B"));
    EXPECT_EQ(readExrHeader(folder / "a.exr").extent, (Extent{64, 36}));
    EXPECT_THAT(readExrHeader(folder / "a.rsm.exr").channels,
                UnorderedElementsAre("light0.depth.Z", "light0.normal.X", "light0.normal.Y", "light0.normal.Z",
                                     "light0.flux.R", "light0.flux.G", "light0.flux.B"));
    EXPECT_EQ(readExrHeader(folder / "a.rsm.exr").extent, (Extent{32, 32}));
    EXPECT_THAT(readExrHeader(folder / "a.shadow.exr").channels, ElementsAre("light0.shadow.Z"));
    EXPECT_EQ(readExrHeader(folder / "a.shadow.exr").extent, (Extent{64, 64}));
    EXPECT_EQ(readPng(folder / "a.png").extent(), (Extent{64, 36}));
    // Two by two panels, each with a label of 11 pixels above it, gutters of 4.
    EXPECT_EQ(readPng(folder / "sheet.png").extent(), (Extent{2 * 64 + 3 * 4, 2 * (36 + 11) + 3 * 4}));
}

TEST_F(Render, LightIsThereAndAddsUp) {
    // Planes: packed pixels, the default on GPUs, round each of these pictures for itself.
    render({"-o", path("a.exr"), "--storage", "planar", "--aov", "albedo,direct,indirect,indirect-irradiance,depth"});
    const HostImage color = layer("a.exr", ""), direct = layer("a.exr", "direct."),
                    indirect = layer("a.exr", "indirect."), albedo = layer("a.exr", "albedo."),
                    irradiance = layer("a.exr", "indirect-irradiance.");
    double sumDirect = 0.0, sumIndirect = 0.0;
    for (int i = 0; i < 64 * 36; ++i)
        for (int c = 0; c < 3; ++c) {
            const float d = direct.pixel(0, 0)[4 * i + c], n = indirect.pixel(0, 0)[4 * i + c];
            ASSERT_GE(d, 0.0f);
            ASSERT_GE(n, 0.0f);
            // One float addition, one product and one division by pi: a few last places.
            EXPECT_FLOAT_EQ(color.pixel(0, 0)[4 * i + c], d + n);
            const float expected = albedo.pixel(0, 0)[4 * i + c] * irradiance.pixel(0, 0)[4 * i + c] / 3.14159265f;
            EXPECT_NEAR(n, expected, 1e-6f * expected);
            sumDirect += double(d);
            sumIndirect += double(n);
        }
    // A closed white box with one lamp: on the screen the bounce is of the order of the direct light (the ceiling has
    // nothing else), and a factor of pi more or less would show.
    EXPECT_GT(sumIndirect, 0.5 * sumDirect);
    EXPECT_LT(sumIndirect, 2.0 * sumDirect);
}

TEST_F(Render, SavedInputsGiveTheSamePixels) {
    for (const Arguments& how : {Arguments{}, Arguments{"--lanes", "1", "--storage", "image"}}) {
        Arguments first{"-o", path("a.exr"), "--aov", "all", "--sheet", path("as.png"), "--save-inputs", path("in")};
        first.insert(first.end(), how.begin(), how.end());
        render(first);
        Arguments second{"indirect", path("in"), "-o", path("b.exr"), "--aov", "all", "--sheet", path("bs.png")};
        second.insert(second.end(), how.begin(), how.end());
        succeed(second);
        // EXRs hold no date, so that equal pixels are equal files.
        for (const char* ending : {".exr", ".rsm.exr", ".shadow.exr", ".png", "s.png"})
            EXPECT_TRUE(readText(path("a") + ending) == readText(path("b") + ending)) << ending;
    }
}

TEST_F(Render, TheReportHoldsEverySettingAsItWasGiven) {
    Arguments arguments{"-o", path("a.png"),  "--report", path("r.json"), "--frames",   "3",           "--lanes",
                        "4",  "--background", "1,2.5,4",  "--sun",        "10,20,3000", "--transport", "host"};
    nlohmann::json expected;
    Settings settings;
    forEachSetting(settings, [&](const SettingInfo& info, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        arguments.push_back(std::string("--") + info.name);
        if constexpr (std::is_same_v<Value, bool>) {
            arguments.push_back(value ? "off" : "on");
            expected[info.name] = !value;
        } else if constexpr (std::is_enum_v<Value>) {
            const char* other = info.names[value == Value(0) ? 1 : 0];
            arguments.push_back(other);
            expected[info.name] = other;
        } else {
            const auto other = Value(double(value) + 0.25 * (info.max - double(value)));
            arguments.push_back(fmt::format("{}", other));
            expected[info.name] = other;
        }
    });
    render(arguments);
    const nlohmann::json report = json("r.json");
    EXPECT_EQ(report["settings"], expected);
    EXPECT_EQ(report["raster"]["size"], (std::vector<int>{64, 36}));
    EXPECT_EQ(report["raster"]["rsm-size"], 32);
    EXPECT_EQ(report["raster"]["background"], (std::vector<double>{1, 2.5, 4}));
    EXPECT_EQ(report["raster"]["sun"]["lux"], 3000);
    EXPECT_EQ(report["scene"]["triangles"], 34);
    EXPECT_EQ(report["device"]["tuning"]["lanes"], 4);
    EXPECT_EQ(report["transport"], "host");
    EXPECT_EQ(report["transportReason"], "asked for");
    // 64 x 36 pixels of 36 bytes; for the lamp and the sun each an RSM of 32 x 32 texels of 28, a shadow map of 64 x 64
    // texels of 4.
    const int frameBytes = 64 * 36 * 36 + 2 * (32 * 32 * 28 + 64 * 64 * 4);
    EXPECT_EQ(report["transportCost"]["hostBytes"], frameBytes * (report["device"]["unifiedMemory"] ? 1 : 2));
    std::vector<std::string> costs;
    for (const auto& part : report["transportCost"]["parts"]) costs.push_back(part["part"]);
    EXPECT_THAT(costs, ElementsAre("wait", "acquire", "release"));
    EXPECT_NE(report["gl"]["renderer"], "");
    EXPECT_GT(report["deviceMemoryBytes"], 64 * 36 * 100);  // a frame's surfaces have more than a hundred bytes a pixel
    EXPECT_EQ(report["frames"], 3);
    EXPECT_EQ(report["framesTimed"], 3);  // and one ahead of them
    EXPECT_GT(report["start"]["firstFrameMs"], 0.0);
    EXPECT_GT(report["start"]["firstPixelMs"], report["start"]["firstFrameMs"]);
    EXPECT_EQ(report["sequence"]["warmup"], 1);
    EXPECT_EQ(report["outputs"], (std::vector<std::string>{path("a.png"), path("r.json")}));
    ASSERT_GT(report["stages"].size(), 3u);
    for (const auto& stage : report["stages"]) {
        EXPECT_GT(stage["minMs"], 0.0) << stage;
        EXPECT_LE(stage["minMs"], stage["medianMs"]);
        EXPECT_LE(stage["medianMs"], stage["maxMs"]);
    }
    std::vector<std::string> steps;
    for (const auto& step : report["steps"]) steps.push_back(step["step"]);
    EXPECT_THAT(steps, ElementsAre("raster", "transport", "compute", "frame"));
}

TEST_F(Render, ValuesThatAreNotFiniteAreCountedAndToldOf) {
    render({"-o", path("a.exr"), "--report", path("r.json"), "--aov", "direct,albedo", "--save-inputs", path("in")});
    EXPECT_EQ(json("r.json")["nonFinite"], (nlohmann::json{{"color", 0}, {"direct", 0}, {"albedo", 0}}));

    // A lamp near the end of what a float holds: less than a metre away its illuminance is beyond.
    edit("in/inputs.json", "\"intensity\": [300.0, 300.0, 300.0]", "\"intensity\": [3e38, 3e38, 3e38]");
    const Result result = runEarthshine(
        {"indirect", path("in"), "-o", path("b.exr"), "--report", path("s.json"), "--aov", "direct,albedo"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.err, HasSubstr("earthshine: warning: " + path("b.exr") + ": direct: "));
    EXPECT_GT(json("s.json")["nonFinite"]["direct"], 0);
    EXPECT_EQ(json("s.json")["nonFinite"]["albedo"], 0);
}

TEST_F(Render, TheBackgroundStandsWhereNothingIs) {
    render({"-o", path("a.exr"), "--background", "1,2.5,4"});
    const HostImage color = layer("a.exr", "");  // the box leaves the sides of a wide picture empty
    EXPECT_EQ(color.pixel(0, 18)[0], 1.0f);
    EXPECT_EQ(color.pixel(0, 18)[1], 2.5f);
    EXPECT_EQ(color.pixel(63, 0)[2], 4.0f);
}

TEST_F(Render, ExposureBrightensThePicture) {
    const auto brightness = [&](const char* stops) {
        render({"-o", path("a.png"), "--exposure", stops});
        const HostImage image = readPng(folder / "a.png");
        double sum = 0.0;
        for (std::size_t i = 0; i < image.sizeBytes(); ++i) sum += double(std::to_integer<int>(image.data()[i]));
        return sum;
    };
    const double dark = brightness("-2"), normal = brightness("0"), bright = brightness("2");
    EXPECT_LT(dark, normal);
    EXPECT_LT(normal, bright);
}

TEST_F(Render, APngAloneIsAPngAlone) {
    render({"-o", path("a.png")});
    EXPECT_THAT(folder.names(), ElementsAre("a.png"));
}

TEST_F(Render, CtrlCLeavesNothing) {
    test::writeText(folder / "a.png", "old");
    test::Process process({"render", EARTHSHINE_DATA_DIR "/cornell.glb", "-o", path("a.exr"), "--save-inputs",
                           path("in"), "--estimator", "sum", "--frames", "100000"});
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (folder.names().size() < 4 && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(folder.names().size(), 4u) << "the temporary outputs of a.exr, a.png and in, beside the old a.png";
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    process.signal(SIGINT);
    EXPECT_EQ(process.wait().exitCode, -SIGINT);
    EXPECT_THAT(folder.names(), ElementsAre("a.png"));
    EXPECT_EQ(readText(folder / "a.png"), "old");
}

TEST_F(Render, IndirectOpensNoGl) {
    render({"-o", path("a.png"), "--save-inputs", path("in")});
    const auto opened = [&](Arguments arguments) {
        const Result result = runEarthshine(arguments, {"LD_DEBUG=files"});  // the loader tells stderr of each library
        EXPECT_EQ(result.exitCode, 0);
        return result.err.find("libEGL.so") != std::string::npos ||
               result.err.find("libOSMesa.so") != std::string::npos;
    };
    EXPECT_TRUE(opened({"render", EARTHSHINE_DATA_DIR "/cornell.glb", "--size", "8x8", "-o", path("a.png")}));
    EXPECT_FALSE(opened({"indirect", path("in"), "-o", path("b.png")}));
}

TEST_F(Render, BrokenInputsEndInOneLine) {
    render({"-o", path("a.png"), "--save-inputs", path("in")});
    fs::remove(folder / "in/rsm_0_flux.exr");
    const Result result = runEarthshine({"indirect", path("in"), "-o", path("b.exr")});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(result.err, "earthshine: " + path("in/rsm_0_flux.exr") + ": no such file\n");
    EXPECT_THAT(folder.names(), ElementsAre("a.png", "in"));
}

TEST_F(Render, AnAovThatIsNotThereIsRefused) {
    render({"-o", path("a.png"), "--save-inputs", path("in")});
    edit("in/inputs.json", "\"motion\": \"motion.exr\",", "");
    const Result result = runEarthshine({"indirect", path("in"), "-o", path("b.exr"), "--aov", "motion"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(result.err, "earthshine: --aov: these inputs have no motion\n");
    succeed({"indirect", path("in"), "-o", path("b.exr"), "--aov", "depth"});
}

}  // namespace
}  // namespace earthshine
