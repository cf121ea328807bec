// `earthshine reference`, `compare` and `quality`, whole, on small pictures.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "image/image_file.hpp"
#include "image/temp_folder.hpp"

namespace earthshine {
namespace {

using test::Arguments;
using test::readText;
using test::Result;
using test::runEarthshine;
using test::TempFolder;
using test::writeText;
using ::testing::HasSubstr;
using ::testing::Not;

class TruthProgram : public ::testing::Test {
protected:
    TempFolder folder;

    std::string path(const std::string& name) const { return (folder / name).string(); }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(readText(folder / name)); }

    static Result succeed(const Arguments& arguments) {
        const Result result = runEarthshine(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_EQ(test::besidesProgress(result.err), "");
        return result;
    }
    Result reference(const std::string& out, const Arguments& more) const {
        Arguments arguments{"reference", EARTHSHINE_DATA_DIR "/cornell.glb", "--size", "40x30", "-o", path(out)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return succeed(arguments);
    }
    static std::string refused(const Arguments& arguments, int exitCode) {
        const Result result = runEarthshine(arguments);
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        return result.err;
    }
};

TEST_F(TruthProgram, ReferenceWritesEveryPartOfTheLight) {
    const Result result = reference("a.exr", {"--spp", "8", "--report", path("r.json")});
    EXPECT_THAT(result.out, HasSubstr("8 a pixel"));
    const ExrHeader header = readExrHeader(folder / "a.exr");
    for (const char* channel : {"R", "direct.R", "indirect.G", "direct-irradiance.B", "indirect-irradiance.R",
                                "albedo.G", "normal.X", "depth.Z"})
        EXPECT_TRUE(header.has(channel)) << channel;
    const auto report = json("r.json");
    EXPECT_EQ(report["samples"], 8);
    EXPECT_EQ(report["stoppedBy"], "samples");
    EXPECT_EQ(report["settings"]["bounces"], "1");
    EXPECT_EQ(report["nonFinite"], 0);
    EXPECT_GT(report["noise"]["relMse"], 0.0);
    EXPECT_GT(report["rays"]["perSecond"], 0.0);
    EXPECT_GT(report["indirectIrradianceMean"], 10.0);
}

TEST_F(TruthProgram, ReferenceStopsAtItsBudgetAndGoesOn) {
    reference("noise.exr", {"--until-relmse", "0.2", "--report", path("noise.json")});
    EXPECT_EQ(json("noise.json")["stoppedBy"], "noise");
    EXPECT_LE(json("noise.json")["noise"]["relMse"], 0.2);
    reference("time.exr", {"--time", "0.2", "--report", path("time.json")});
    EXPECT_EQ(json("time.json")["stoppedBy"], "time");
    EXPECT_LT(json("time.json")["rays"]["seconds"], 10.0);

    reference("whole.exr", {"--spp", "12"});
    reference("half.exr", {"--spp", "5", "--resume", path("sums")});
    reference("rest.exr", {"--spp", "12", "--resume", path("sums"), "--threads", "1"});
    const Result same = succeed({"compare", path("rest.exr"), path("whole.exr"), "--json"});
    EXPECT_EQ(nlohmann::json::parse(same.out)["mse"], 0.0);
    EXPECT_THAT(refused({"reference", EARTHSHINE_DATA_DIR "/cornell.glb", "--size", "40x30", "-o", path("x.exr"),
                         "--resume", path("sums"), "--bounces", "2"},
                        1),
                HasSubstr("another scene"));
    EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
}

TEST_F(TruthProgram, ReferenceKnowsBouncesAndVisibility) {
    const auto mean = [&](const std::string& name, Arguments more) {
        more.insert(more.end(), {"--spp", "32", "--report", path(name + ".json")});
        reference(name + ".exr", more);
        return json(name + ".json")["indirectIrradianceMean"].get<double>();
    };
    EXPECT_EQ(mean("none", {"--bounces", "0"}), 0.0);
    const double one = mean("one", {});
    EXPECT_GT(mean("all", {"--bounces", "all"}), 1.1 * one);
    EXPECT_GT(mean("open", {"--no-indirect-visibility"}), 1.1 * one);
}

TEST_F(TruthProgram, ReferenceRefusesInOneLine) {
    const std::string scene = EARTHSHINE_DATA_DIR "/cornell.glb";
    EXPECT_THAT(refused({"reference", scene, "-o", path("a.png")}, 2), HasSubstr(".exr"));
    EXPECT_THAT(refused({"reference", scene, "-o", path("a.exr"), "--bounces", "few"}, 2), HasSubstr("--bounces"));
    EXPECT_THAT(refused({"reference", scene, "-o", path("a.exr"), "--bounces", "2", "--no-indirect-visibility"}, 2),
                HasSubstr("one bounce"));
    EXPECT_THAT(refused({"reference", scene, "-o", path("a.exr"), "--rsm-size", "8"}, 2), HasSubstr("--rsm-size"));
    EXPECT_THAT(refused({"reference", path("none.glb"), "-o", path("a.exr")}, 1), HasSubstr("none.glb"));
    EXPECT_THAT(folder.names(), ::testing::IsEmpty());
}

TEST_F(TruthProgram, ComparePrintsNumbersAndAPicture) {
    reference("a.exr", {"--spp", "4"});
    reference("b.exr", {"--spp", "64"});
    const Result text = succeed({"compare", path("a.exr"), path("b.exr"), "--picture", path("d.png")});
    for (const char* word : {"relMSE", "MAE", "PSNR", "SSIM", "LDR-FLIP", "HDR-FLIP", "d.png"})
        EXPECT_THAT(text.out, HasSubstr(word));
    EXPECT_GT(readPng(folder / "d.png").extent().widthPx, 80);
    const auto compared = [&](Arguments more) {
        Arguments arguments{"compare", path("a.exr"), path("b.exr"), "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return nlohmann::json::parse(succeed(arguments).out);
    };
    const auto color = compared({}), direct = compared({"--layer", "direct-irradiance"}),
               red = compared({"--channels", "indirect.R"}), unmasked = compared({"--mask-sky", "off"});
    EXPECT_GT(color["relMse"], 0.0);
    EXPECT_GT(color["maskedPixels"], 0);  // sky beside the box
    EXPECT_EQ(unmasked["maskedPixels"], 0);
    EXPECT_EQ(unmasked["pixels"], 40 * 30);
    EXPECT_EQ(direct["relMse"], 0.0);  // exact in both
    EXPECT_TRUE(direct["psnrDb"].is_null());
    EXPECT_EQ(red["channels"], nlohmann::json::array({"indirect.R"}));
    EXPECT_GT(red["relMse"], color["relMse"]);
}

TEST_F(TruthProgram, CompareRefusesWhatDoesNotCompare) {
    reference("a.exr", {"--spp", "2"});
    HostImage small(PixelFormat::RGBA32F, {8, 8}), picture(PixelFormat::RGBA8, {40, 30});
    const Layer layer{"", small.view(), {"R", "G", "B"}};
    writeExr(folder / "small.exr", {&layer, 1});
    writePng(folder / "p.png", picture.view());
    const auto compared = [&](const Arguments& more, int exitCode) {
        Arguments arguments{"compare", path("a.exr")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return refused(arguments, exitCode);
    };
    EXPECT_THAT(compared({path("small.exr")}, 1), HasSubstr("one size"));
    EXPECT_THAT(compared({path("p.png")}, 1), HasSubstr("like with like"));
    EXPECT_THAT(compared({path("a.exr"), "--layer", "beauty"}, 1), HasSubstr("indirect-irradiance"));
    EXPECT_THAT(compared({path("a.exr"), "--channels", "R,G"}, 2), HasSubstr("one or three"));
    EXPECT_THAT(compared({path("a.exr"), "--picture", path("d.jpg")}, 2), HasSubstr(".png"));
    EXPECT_THAT(compared({path("gone.exr")}, 1), HasSubstr("gone.exr"));
}

TEST_F(TruthProgram, ComparePngs) {
    HostImage a(PixelFormat::RGBA8, {20, 10}), b(PixelFormat::RGBA8, {20, 10});
    for (std::size_t i = 0; i < a.sizeBytes(); ++i) {
        a.data()[i] = std::byte(i % 4 == 3 ? 255 : 102);
        b.data()[i] = std::byte(i % 4 == 3 ? 255 : 128);
    }
    writePng(folder / "a.png", a.view());
    writePng(folder / "b.png", b.view());
    const auto json = nlohmann::json::parse(succeed({"compare", path("a.png"), path("b.png"), "--json"}).out);
    EXPECT_NEAR(json["psnrDb"].get<double>(), -20.0 * std::log10(26.0 / 255.0), 1e-3);
    EXPECT_FALSE(json.contains("hdrFlip"));
}

TEST_F(TruthProgram, QualityMakesOneTable) {
    writeText(folder / "list.json", fmt::format(R"({{"scenes": [{{"file": "{}/cornell.glb"}}],
        "settings": [{{"series": "sum", "estimator": "sum"}},
                     {{"series": "disk", "estimator": "disk", "spp": 4, "radius": 1.5}},
                     {{"series": "disk", "estimator": "disk", "spp": 64, "radius": 1.5}}]}})",
                                                EARTHSHINE_DATA_DIR));
    const Arguments arguments{"quality", path("list.json"), "-o",  path("q"), "--size", "32x32",     "--rsm-size",
                              "64",      "--shadow-size",   "128", "--noise", "0.05",   "--repeats", "1"};
    const Result first = succeed(arguments);
    EXPECT_THAT(first.out, HasSubstr("| sum |"));
    for (const char* name : {"q/quality.md", "q/quality.json", "q/cornell-ms.svg", "q/cornell-samples.svg"})
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    EXPECT_THAT(readText(folder / "q/cornell-samples.svg"), HasSubstr("spp 64"));
    const auto scene = json("q/quality.json")["scenes"][0];
    ASSERT_EQ(scene["rows"].size(), 3u);
    // 64 texels a side and a reference with noise: a few percent in the mean.
    EXPECT_NEAR(scene["rows"][0]["unoccluded"]["meanError"].get<double>(), 0.0, 0.06);
    EXPECT_GT(scene["rows"][0]["oneBounce"]["meanError"].get<double>(), 0.05);
    EXPECT_GT(scene["rows"][1]["unoccluded"]["relMse"], scene["rows"][2]["unoccluded"]["relMse"]);
    EXPECT_LE(scene["references"]["oneBounce"]["noiseRelMse"], 0.05);

    // The second time references come from the cache.
    std::vector<std::filesystem::file_time_type> times;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "q/references"))
        times.push_back(entry.last_write_time());
    EXPECT_EQ(times.size(), 4u);
    succeed(arguments);
    for (const auto& entry : std::filesystem::directory_iterator(folder / "q/references"))
        EXPECT_THAT(times, ::testing::Contains(entry.last_write_time()));
}

TEST_F(TruthProgram, QualityRefusesListsThatMakeNoSense) {
    const auto list = [&](const std::string& text) {
        writeText(folder / "list.json", text);
        return refused({"quality", path("list.json"), "-o", path("q")}, 1);
    };
    const std::string scenes = R"("scenes": [{"file": "a.glb"}])";
    EXPECT_THAT(list("{"), HasSubstr("no JSON"));
    EXPECT_THAT(list("{}"), HasSubstr("'scenes'"));
    EXPECT_THAT(list("[]"), HasSubstr("must be an object"));
    EXPECT_THAT(list("{" + scenes + R"(, "settings": [{"spp": 0}]})"), HasSubstr("settings[0]"));
    EXPECT_THAT(list("{" + scenes + R"(, "settings": [{"sppp": 8}]})"), HasSubstr("'sppp'"));
    EXPECT_THAT(list("{" + scenes + R"(, "settings": [{"estimator": "guess"}]})"), HasSubstr("guess"));
    EXPECT_THAT(list("{" + scenes + R"(, "settings": [{"preset": "best"}]})"), HasSubstr("'best' is none of still"));
    EXPECT_THAT(list("{" + scenes + R"(, "settings": [{"frames": 0}]})"), HasSubstr("'frames' must be in [1; 1000]"));
    EXPECT_THAT(list("{" + scenes + R"(, "settings": [{"radius": "wide"}]})"), HasSubstr("'radius'"));
    EXPECT_THAT(list(R"({"scenes": [{"camera": "x"}], "settings": [{}]})"), HasSubstr("scenes[0]"));
    EXPECT_FALSE(std::filesystem::exists(folder / "q" / "quality.md"));
}

}  // namespace
}  // namespace earthshine
