// `earthshine render` over several frames: what moves, which files come of it, and what a restart gives.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
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

class Sequences : public ::testing::Test {
protected:
    /// moving.glb at 64x36 with small maps, and what `more` asks for.
    static Arguments renderArguments(const Arguments& more) {
        Arguments arguments{"render",        EARTHSHINE_DATA_DIR "/moving.glb",
                            "--size",        "64x36",
                            "--rsm-size",    "32",
                            "--shadow-size", "64",
                            "--spp",         "16"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    static Result render(const Arguments& more, const std::vector<std::string>& environment = {}) {
        const Result result = runEarthshine(renderArguments(more), environment);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_EQ(test::besidesProgress(result.err), "");
        return result;
    }

    std::string path(const std::string& name) const { return (folder / name).string(); }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(readText(folder / name)); }
    /// The light and camera of the last frame of a sequence.
    nlohmann::json lastInputs(Arguments arguments) {
        fs::remove_all(folder / "in");
        arguments.insert(arguments.end(), {"-o", path("a.png"), "--save-inputs", path("in")});
        render(arguments);
        return json("in/inputs.json");
    }
    /// The greatest motion of a frame, px.
    double motion(const std::string& file) const {
        const std::vector<std::string> channels{"motion.X", "motion.Y"};
        const HostImage image = readExr(folder / file, channels, PixelFormat::RGBA32F);
        double most = 0.0;
        for (int i = 0; i < 64 * 36; ++i)
            for (int c = 0; c < 2; ++c) most = std::max(most, std::abs(double(image.pixel(0, 0)[4 * i + c])));
        return most;
    }
    /// A program in the place of ffmpeg, and PATH with it alone in front.
    std::vector<std::string> fakeFfmpeg(const std::string& script) {
        fs::create_directory(folder / "bin");
        test::writeText(folder / "bin/ffmpeg", "#!/bin/sh\n" + script);
        ::chmod((folder / "bin/ffmpeg").c_str(), 0755);
        return {"PATH=" + path("bin") + ":/usr/bin:/bin"};
    }

    TempFolder folder;
};

TEST_F(Sequences, ARestartGivesTheSameFilesAsTheWholeRun) {
    test::writeText(
        folder / "sun.json",
        R"({"keys": [{"frame": 0, "sun": [135, 50, 2000]}, {"frame": 3, "sun": [200, 40, 9000], "step": true}]})");
    const Arguments moves{"--frames",   "5",          "--path",         "orbit:3", "--animate", "on",       "--fps",
                          "4",          "--sun-path", path("sun.json"), "--aov",   "all",       "--preset", "balanced",
                          "--feedback", "1"};  // history, so that the frames before count
    Arguments whole = moves, rest = moves;
    whole.insert(whole.end(), {"-o", path("whole.###.exr"), "--sheet", path("whole.sheet.#.png")});
    rest.insert(rest.end(), {"-o", path("rest.###.exr"), "--sheet", path("rest.sheet.#.png"), "--first-frame", "3"});
    render(whole);
    render(rest);
    EXPECT_FALSE(fs::exists(path("rest.002.exr")));
    for (const int frame : {3, 4}) {
        for (const char* name :
             {"{}.00{}.exr", "{}.00{}.png", "{}.00{}.rsm.exr", "{}.00{}.shadow.exr", "{}.sheet.{}.png"}) {
            // EXRs hold no date, so that equal pixels are equal files.
            const std::string one = path(fmt::format(fmt::runtime(name), "whole", frame));
            const std::string other = path(fmt::format(fmt::runtime(name), "rest", frame));
            ASSERT_TRUE(fs::exists(one) && fs::exists(other)) << one;
            EXPECT_TRUE(readText(one) == readText(other)) << one;
        }
    }
    EXPECT_FALSE(readText(path("whole.003.exr")) == readText(path("whole.004.exr")));
}

TEST_F(Sequences, NumbersAreFilledUpWithZerosAndWithoutThemTheLastFrameIsKept) {
    render({"--frames", "11", "--first-frame", "9", "--path", "orbit", "-o", path("a.##.png"), "--report",
            path("r.json")});
    EXPECT_THAT(folder.names(), ElementsAre("a.09.png", "a.10.png", "r.json"));
    EXPECT_EQ(json("r.json")["framesTimed"], 2);
    EXPECT_EQ(json("r.json")["sequence"]["firstFrame"], 9);
    EXPECT_EQ(json("r.json")["outputs"].size(), 3u);
    render({"--frames", "11", "--path", "orbit", "-o", path("last.png"), "--sheet", path("s.#.png")});
    EXPECT_TRUE(readText(path("last.png")) == readText(path("a.10.png")));
    EXPECT_TRUE(fs::exists(path("s.0.png")) && fs::exists(path("s.10.png")));
}

TEST_F(Sequences, MotionIsThatOfTheFrameBefore) {
    render({"--frames", "3", "--path", "orbit:2", "-o", path("orbit.#.exr"), "--aov", "motion"});
    render({"--frames", "3", "--animate", "slide", "--fps", "10", "-o", path("slide.#.exr"), "--aov", "motion"});
    render({"--frames", "3", "--animate", "swing", "-o", path("swing.#.exr"), "--aov", "motion"});
    for (const char* name : {"orbit", "slide"}) {
        EXPECT_EQ(motion(fmt::format("{}.0.exr", name)), 0.0) << name;
        EXPECT_GT(motion(fmt::format("{}.1.exr", name)), 0.2) << name;
        // Both move steadily, so that a frame's motion is about that of the one before, and not that since the start.
        EXPECT_NEAR(motion(fmt::format("{}.2.exr", name)) / motion(fmt::format("{}.1.exr", name)), 1.0, 0.3) << name;
    }
    EXPECT_EQ(motion("swing.2.exr"), 0.0);  // a light alone moves nothing that is seen
}

TEST_F(Sequences, TheFilesOwnCameraIsFollowed) {
    // dolly: z from -0.8 to -0.5 in two seconds. View z of the origin is what the camera's z is.
    const auto z = [&](const char* frames) {
        return lastInputs(
                   {"--path", "animation:dolly", "--frames", frames, "--fps", "4"})["camera"]["viewFromWorld"][14]
            .get<double>();
    };
    EXPECT_NEAR(z("1"), -0.8, 1e-6);
    EXPECT_NEAR(z("5"), -0.65, 1e-6);
    EXPECT_NEAR(z("20"), -0.5, 1e-6);
}

TEST_F(Sequences, TheSunMovesAndShinesInPlaceOfTheScenes) {
    const auto sun = [&](const char* frames) {
        return lastInputs({"--sun", "90,30,1000", "--sun-path", "10,5", "--frames", frames})["lights"][0];
    };
    // The sun's direction is the third row of its view, as light_fit.hpp has it.
    const auto expectDirection = [](const nlohmann::json& light, double azimuthDeg, double elevationDeg) {
        constexpr double kDeg = 3.14159265358979 / 180;
        const double a = azimuthDeg * kDeg, e = elevationDeg * kDeg;
        EXPECT_EQ(light["name"], "sun");
        EXPECT_NEAR(light["camera"]["viewFromWorld"][2].get<double>(), std::sin(a) * std::cos(e), 1e-6);
        EXPECT_NEAR(light["camera"]["viewFromWorld"][6].get<double>(), std::sin(e), 1e-6);
        EXPECT_NEAR(light["camera"]["viewFromWorld"][10].get<double>(), -std::cos(a) * std::cos(e), 1e-6);
    };
    expectDirection(sun("1"), 90, 30);
    expectDirection(sun("4"), 120, 45);
}

TEST_F(Sequences, AStillSpotKeepsItsMapWhileTheCubeSlides) {
    const auto spot = [&](const char* frames) {
        return lastInputs({"--animate", "slide", "--fps", "4", "--frames", frames})["lights"][0];
    };
    const nlohmann::json first = spot("1");
    EXPECT_EQ(first, spot("3"));
    EXPECT_EQ(first, spot("8"));
}

TEST_F(Sequences, TheFilmGetsTheBytesOfEveryFrame) {
    const auto environment = fakeFfmpeg("for last; do :; done\necho \"$@\" >\"${0%/*}/../words\"\ncat >\"$last\"\n");
    render({"--frames", "3", "--first-frame", "1", "--path", "orbit:5", "-o", path("a.#.png"), "--film", path("f.mp4"),
            "--fps", "12"},
           environment);
    const std::string film = readText(path("f.mp4"));
    ASSERT_EQ(film.size(), 2u * 64 * 36 * 4);
    for (const int frame : {1, 2}) {
        const HostImage picture = readPng(folder / fmt::format("a.{}.png", frame));
        const std::string bytes(reinterpret_cast<const char*>(picture.data()), picture.sizeBytes());
        EXPECT_TRUE(film.substr(std::size_t(frame - 1) * bytes.size(), bytes.size()) == bytes) << frame;
    }
    const std::string words = readText(path("words"));
    for (const char* word : {"-video_size 64x36", "-framerate 12", "-pixel_format rgba", "-f mp4"})
        EXPECT_THAT(words, HasSubstr(word));
}

TEST_F(Sequences, WithoutFfmpegNothingIsBegun) {
    const Result result =
        runEarthshine(renderArguments({"-o", path("a.png"), "--film", path("f.mp4")}), {"PATH=" + path("none")});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(
        result.err,
        "earthshine: --film: there is no ffmpeg on PATH; install it, or write numbered pictures (-o out.####.png)\n");
    EXPECT_TRUE(folder.names().empty());
}

TEST_F(Sequences, AnFfmpegThatFailsEndsInOneLineAndWithoutAFilm) {
    for (const char* script : {"cat >/dev/null\necho 'one' >&2\necho 'no such codec' >&2\nexit 3\n",
                               "echo 'no such codec' >&2\nexit 3\n"}) {  // at the end, and at once
        const auto environment = fakeFfmpeg(script);
        const Result result = runEarthshine(
            renderArguments({"--frames", "40", "-o", path("a.png"), "--film", path("f.mp4")}), environment);
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_EQ(test::besidesProgress(result.err),
                  "earthshine: " + path("f.mp4") + ": ffmpeg failed (exit code 3): no such codec\n");
        EXPECT_THAT(folder.names(), ElementsAre("bin"));
        fs::remove_all(folder / "bin");
    }
}

TEST_F(Sequences, CtrlCLeavesWholeFramesAlone) {
    const auto environment = fakeFfmpeg("for last; do :; done\ncat >\"$last\"\n");
    test::Process process(renderArguments({"--frames", "100000", "-o", path("a.####.exr"), "--film", path("f.mp4")}),
                          environment);
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!fs::exists(path("a.0002.exr")) && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    process.signal(SIGINT);
    EXPECT_EQ(process.wait().exitCode, -SIGINT);
    for (const std::string& name : folder.names()) {
        EXPECT_THAT(name, ::testing::AnyOf("bin", ::testing::StartsWith("a.0")));
        if (name.ends_with(".exr")) {
            EXPECT_EQ(readExrHeader(folder / name).extent, (Extent{64, 36})) << name;
        }
    }
    EXPECT_TRUE(fs::exists(path("a.0002.exr")));
}

// `motion`: errors of every frame, and a jump that history forgets.
TEST_F(Sequences, MotionMeasuresFlickerAndGhosts) {
    test::writeText(folder / "list.json", fmt::format(R"({{
        "scenes": [{{"file": "{}/cornell.glb"}}],
        "settings": [{{"preset": "balanced"}}, {{"preset": "balanced", "accumulate": false}}]}})",
                                                      EARTHSHINE_DATA_DIR));
    const Result result = runEarthshine({"motion", path("list.json"), "-o", path("m.json"), "--size", "64x36",
                                         "--rsm-size", "64", "--shadow-size", "64", "--frames", "20", "--jump", "11"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("8 frames after the sun jumped"));
    const nlohmann::json scene = json("m.json")["scenes"][0];
    const nlohmann::json with = scene["rows"][0], without = scene["rows"][1];
    EXPECT_EQ(with["relMse"].size(), 20u);
    EXPECT_EQ(with["flicker"].size(), 18u);  // neither into the first frame nor into the jump
    // History is what it is for: less error and less flicker than a filter alone has, and more than the truth's own.
    EXPECT_LT(with["relMse"][10], without["relMse"][10]);
    EXPECT_LT(with["flicker"][9], without["flicker"][9]);
    EXPECT_GT(with["flicker"][9], scene["fullSumFlicker"]);
    // Of large walls nearly all is seen again: all but what comes into view and what the edges between them hide.
    EXPECT_GT(scene["flickerPixels"], 0.9);
    EXPECT_LT(scene["flickerPixels"], 1.0);
    // Without history a past changes only which noise there is.
    EXPECT_LT(double(with["relMseAfterJump"]), 3.0 * double(with["relMseWithoutPast"]));
}

TEST_F(Sequences, WarmupIsNeitherTimedNorAsked) {
    render({"--frames", "2", "--warmup", "0", "-o", path("a.png"), "--report", path("r.json")});
    EXPECT_EQ(json("r.json")["framesTimed"], 2);
    const Result cold = render({"-o", path("b.png"), "--report", path("r.json")});
    EXPECT_THAT(cold.out, HasSubstr("The first frame compiles"));
    const Result warm = render({"--warmup", "2", "-o", path("b.png"), "--report", path("r.json")});
    EXPECT_THAT(warm.out, ::testing::Not(HasSubstr("The first frame compiles")));
    EXPECT_EQ(json("r.json")["framesTimed"], 1);
    EXPECT_EQ(json("r.json")["sequence"]["warmup"], 2);
}

}  // namespace
}  // namespace earthshine
