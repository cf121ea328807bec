// What the program says and returns when it is asked for something that it cannot do.

#include <gmock/gmock.h>

#include "cli/process.hpp"
#include "earthshine/settings.hpp"
#include "image/temp_folder.hpp"

namespace earthshine {
namespace {

using test::Arguments;
using test::Result;
using test::runEarthshine;
using test::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kScene = EARTHSHINE_DATA_DIR "/cornell.glb";

/// One line `earthshine: ...` on stderr that holds `message`; nothing on stdout.
void expectRefusal(const Result& result, int exitCode, const std::string& message) {
    EXPECT_EQ(result.exitCode, exitCode);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, StartsWith("earthshine: "));
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << "not one line";
}

struct Refusal {
    Arguments arguments;  ///< "@/" becomes the test's folder, "@scene" and "@moving" a scene
    int exitCode;
    std::string message;
};

void PrintTo(const Refusal& refusal, std::ostream* stream) {
    for (const std::string& word : refusal.arguments) *stream << word << ' ';
}

class Refused : public ::testing::TestWithParam<Refusal> {};

TEST_P(Refused, InOneLineAndWithoutATrace) {
    const TempFolder folder;
    test::writeText(folder / "old.png", "old");
    test::writeText(folder / "text.glb", "no glTF at all");
    Arguments arguments = GetParam().arguments;
    for (std::string& word : arguments) {
        if (word == "@scene") word = kScene;
        if (word == "@moving") word = EARTHSHINE_DATA_DIR "/moving.glb";
        if (word.starts_with("@/")) word = (folder / word.substr(2)).string();
    }
    expectRefusal(runEarthshine(arguments), GetParam().exitCode, GetParam().message);
    EXPECT_THAT(folder.names(), ElementsAre("old.png", "text.glb"));
    EXPECT_EQ(test::readText(folder / "old.png"), "old");
}

// 2: the command line makes no sense, whatever is on the disk. 1: it does, but what it names does not go along.
INSTANTIATE_TEST_SUITE_P(
    CommandLine, Refused,
    ::testing::Values(
        Refusal{{}, 2, "subcommand is required"}, Refusal{{"paint"}, 2, "no command 'paint'"},
        Refusal{{"render"}, 2, "scene is required"}, Refusal{{"render", "@scene"}, 2, "--out is required"},
        Refusal{{"render", "@scene", "-o"}, 2, "--out: needs a value"},
        Refusal{{"render", "@scene", "-o", ""}, 2, "--out: must not be empty"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--shiny"}, 2, "'--shiny'"},
        Refusal{{"render", "@scene", "b.glb", "-o", "@/a.png"}, 2, "'b.glb'"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "-o", "@/b.png"}, 2, "--out: given more than once"},
        Refusal{{"render", "@scene", "-o", "@/a.jpg"}, 2, "must end in .exr or .png"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--sheet", "@/s.exr"}, 2, "--sheet: "},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--report", "@/r.txt"}, 2, "--report: "},
        Refusal{{"render", "@scene", "-o", "@/a.exr", "--sheet", "@/a.png"}, 2, "two outputs have this path"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--aov", "depth"}, 2, "--aov: needs an --out"},
        Refusal{{"render", "@scene", "-o", "@/a.exr", "--aov", "depht"}, 2, "'depht' is none of albedo"}));

INSTANTIATE_TEST_SUITE_P(
    Values, Refused,
    ::testing::Values(
        Refusal{{"render", "@scene", "-o", "@/a.png", "--tuning", "@/text.glb"}, 1, "text.glb:1: 4 columns, must be 6"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--tuning", "@/none"}, 1, "none: cannot be opened"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--size", "0x0"}, 2, "--size: 0 is not in [1; 16384]"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--size", "-64x36"}, 2, "--size: -64 is not in"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--size", "20000x2"}, 2, "--size: 20000 is not in"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--size", "64"}, 2, "--size: '64' is not WIDTHxHEIGHT"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--size", "64x36x2"}, 2, "--size: '36x2' is not a whole number"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--spp", "0"}, 2, "--spp: 0 is not in [1; 4096]"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--spp", "2.5"}, 2, "--spp: '2.5' is not a whole number"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--spp", "99999999999"}, 2, "--spp: 99999999999 is not in"},
        Refusal{
            {"render", "@scene", "-o", "@/a.png", "--preset", "best"}, 2, "--preset: 'best' is none of still, fast"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--feedback", "2"}, 2, "feedback: history cannot remember"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--radius", "nan"}, 2, "--radius: nan is not in"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--exposure", "-inf"}, 2, "--exposure: -inf is not in"},
        Refusal{
            {"render", "@scene", "-o", "@/a.png", "--estimator", "all"}, 2, "--estimator: 'all' is none of disk, sum"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--auto-exposure", "yes"}, 2, "'yes' is none of off, on"},
        Refusal{
            {"render", "@scene", "-o", "@/a.png", "--sun", "135"}, 2, "--sun: '135' is not AZIMUTH,ELEVATION[,LUX]"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--sun", "135,91"}, 2, "--sun: 91 is not in [-90; 90] degrees"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--sun", "135,50,-1"}, 2, "--sun: -1 is not in"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--sun", "a,b,c"}, 2, "--sun: 'a' is not a number"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--background", "1,2"}, 2, "--background: '1,2' is not three"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--rsm-size", "0"}, 2, "--rsm-size: 0 is not in"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--frames", "0"}, 2, "--frames: 0 is not in"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--lanes", "3"}, 2, "--lanes: '3' is none of 1, 4, 8, 16"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--transport", "air"}, 2, "--transport: 'air' is none of"},
        Refusal{
            {"render", "@scene", "-o", "@/a.png", "--transport", "gl-sharing"}, 1, "transport gl-sharing: no cl_khr"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--device", "no such thing"}, 2, "no such thing"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--gl", "metal"}, 2, "\"metal\""},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--camera", "nobody"}, 2, "no camera \"nobody\""},
        Refusal{{"motion", "@/no.json", "-o", "@/m.json"}, 1, "no.json: cannot be read"},
        Refusal{
            {"motion", "@/no.json", "-o", "@/m.json", "--frames", "9", "--jump", "4"}, 2, "--jump: 4 leaves less than"},
        Refusal{{"devices", "--device", "1000"}, 2, "1000"}));

INSTANTIATE_TEST_SUITE_P(
    Sequences, Refused,
    ::testing::Values(
        Refusal{{"render", "@scene", "-o", "@/a.png", "--frames", "4", "--first-frame", "4"},
                2,
                "--first-frame: 4 is beyond the last of 4 frames, 3"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--warmup", "-1"}, 2, "--warmup: -1 is not in"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--fps", "0"}, 2, "--fps: 0 is not in"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--path", "circle"}, 2, "--path: 'circle' is none of orbit["},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--path", "orbit:fast"}, 2, "--path: 'fast' is not a number"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--path", "@/no.json"}, 1, "no.json: no such file"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--path", "animation"}, 2, "has no animation"},
        Refusal{{"render", "@moving", "-o", "@/a.png", "--path", "animation:slide"},
                2,
                "--path: the animation does not move the camera \"cornell\""},
        Refusal{{"render", "@moving", "-o", "@/a.png", "--animate", "run"},
                2,
                "no animation \"run\"; there is 0 \"slide\""},
        Refusal{{"render", "@moving", "-o", "@/a.png", "--path", "animation:dolly", "--animate", "slide"},
                2,
                "--animate: 'slide' is not what --path animation:dolly plays"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--sun-path", "1"}, 2, "--sun-path: '1' is neither AZIMUTH"},
        Refusal{{"render", "@scene", "-o", "@/a.#.#.png"}, 2, "--out: '"},
        Refusal{{"render", "@scene", "-o", "@/a.#.png", "--sheet", "@/a.0.png"}, 2, "two outputs have this path"},
        Refusal{{"render", "@scene", "-o", "@/no/a.##.png", "--frames", "3"}, 1, "there is no folder"},
        Refusal{{"render", "@scene", "-o", "@/a.##.png", "--aov", "depth"}, 2, "--aov: needs an --out"},
        Refusal{{"render", "@scene", "-o", "@/a.png", "--film", "@/f.gif"}, 2, "--film: '"}));

INSTANTIATE_TEST_SUITE_P(
    Files, Refused,
    ::testing::Values(Refusal{{"render", "@/missing.glb", "-o", "@/a.png"}, 1, "missing.glb"},
                      Refusal{{"render", "@/text.glb", "-o", "@/old.png"}, 1, "text.glb"},
                      Refusal{{"render", "@/", "-o", "@/a.png"}, 1, "not a file"},
                      Refusal{{"render", "@scene", "-o", "@/no/such/a.png"}, 1, "there is no folder"},
                      Refusal{{"render", "@scene", "-o", "/proc/a.png"}, 1, "/proc/a.png: cannot be written"},
                      Refusal{
                          {"render", "@scene", "-o", "@/a.png", "--report", "@/no/r.json"}, 1, "there is no folder"},
                      Refusal{{"render", "@scene", "-o", "@/a.png", "--save-inputs", "@/"}, 1, "holds other things"},
                      Refusal{{"render", "@scene", "-o", "@/a.png", "--save-inputs", "@/old.png"}, 1, "is no folder"},
                      Refusal{{"indirect", "@/missing", "-o", "@/a.png"}, 1, "missing: no such folder"},
                      Refusal{{"indirect", "@/", "-o", "@/a.png"}, 1, "inputs.json: no such file"}));

TEST(Help, NamesEveryCommandAndSetting) {
    const Result program = runEarthshine({"--help"});
    EXPECT_EQ(program.exitCode, 0);
    EXPECT_EQ(program.err, "");
    for (const char* command : {"render", "indirect", "devices"}) EXPECT_THAT(program.out, HasSubstr(command));
    for (const char* command : {"render", "indirect"}) {
        const Result help = runEarthshine({command, "--help"});
        EXPECT_EQ(help.exitCode, 0);
        const Settings settings;
        forEachSetting(settings, [&](const SettingInfo& info, const auto&) {
            EXPECT_THAT(help.out, HasSubstr(std::string("--") + info.name + " "));
            EXPECT_THAT(help.out, HasSubstr(info.help));
        });
    }
}

TEST(Help, Version) {
    const Result result = runEarthshine({"--version"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.out, ::testing::MatchesRegex("earthshine [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

}  // namespace
}  // namespace earthshine
