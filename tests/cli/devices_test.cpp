// `earthshine devices`.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "earthshine/device.hpp"
#include "image/temp_folder.hpp"

namespace earthshine {
namespace {

using test::Result;
using test::runEarthshine;
using ::testing::HasSubstr;

TEST(Devices, TheTableHoldsEveryDeviceAndMarksTheChosenOne) {
    const Result result = runEarthshine({"devices"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
    const DeviceCaps chosen = selectDevice("");
    for (const DeviceCaps& caps : listDevices())
        EXPECT_THAT(result.out, HasSubstr(fmt::format("{} {}: {}\n", caps.index == chosen.index ? "*" : " ", caps.index,
                                                      caps.name)));
    EXPECT_THAT(result.out, HasSubstr(fmt::format("* device {} would be used: ", chosen.index)));
    EXPECT_THAT(result.out, HasSubstr(chosen.tuning.reason));
}

TEST(Devices, JsonHoldsTheSame) {
    const std::vector<DeviceCaps> devices = listDevices();
    const Result result = runEarthshine({"devices", "--json", "--device", fmt::format("{}", devices.back().index)});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    ASSERT_EQ(json["devices"].size(), devices.size());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const auto& entry = json["devices"][i];
        EXPECT_EQ(entry["index"], devices[i].index);
        EXPECT_EQ(entry["name"], devices[i].name);
        EXPECT_EQ(entry["imageFormats"], devices[i].imageFormats);
        EXPECT_EQ(entry["transports"], devices[i].transports);
        EXPECT_EQ(entry["unusable"], devices[i].unusable);
        EXPECT_EQ(entry["tuning"]["lanes"], devices[i].tuning.lanes);
        EXPECT_EQ(entry["localMemoryBytes"], devices[i].localMemoryBytes);
    }
    EXPECT_EQ(json["chosen"], devices.back().index);
    EXPECT_NE(json["why"], "");
}

TEST(Devices, AUsersTuningIsShownWithItsSource) {
    const test::TempFolder folder;
    const std::string path = (folder / "own.tuning").string();
    test::writeText(path, "default * * 1 planar 8x2\ndefault * rsm_gather - - 4x3\n");
    const std::vector<std::string> environment{"EARTHSHINE_TUNING=" + path};
    const Result table = runEarthshine({"devices"}, environment);
    EXPECT_EQ(table.exitCode, 0) << table.err;
    EXPECT_THAT(table.out, HasSubstr("lanes 1, planar storage, packed RSM, groups of 8x2\n"));
    EXPECT_THAT(table.out, HasSubstr("rsm_gather         4x3\n"));
    EXPECT_THAT(table.out, HasSubstr(path + ", default: 1 pixel a work-item, planes"));
    const Result json = runEarthshine({"devices", "--json"}, environment);
    EXPECT_THAT(json.out, HasSubstr("\"rsm_gather\""));
    test::writeText(path, "default * * 3 planar 8x2\n");
    const Result refused = runEarthshine({"devices"}, environment);
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_EQ(refused.err, "earthshine: " + path + ":1: lanes '3' is none of 1, 4, 8, 16, native, -\n");
}

TEST(Devices, WithoutAnyTheProgramSaysSo) {
    const test::TempFolder empty;  // of drivers; with the slash for ocl-icd, which else takes it for a file
    const std::vector<std::string> none{"OCL_ICD_VENDORS=" + empty.path().string() + "/", "OCL_ICD_FILENAMES="};
    const Result list = runEarthshine({"devices"}, none);
    EXPECT_EQ(list.exitCode, 0);
    EXPECT_THAT(list.out, HasSubstr("no device can be used: "));
    const Result json = runEarthshine({"devices", "--json"}, none);
    EXPECT_TRUE(nlohmann::json::parse(json.out)["chosen"].is_null());
    const Result render =
        runEarthshine({"render", EARTHSHINE_DATA_DIR "/cornell.glb", "-o", (empty / "a.png").string()}, none);
    EXPECT_EQ(render.exitCode, 1);
    EXPECT_EQ(render.err.find('\n'), render.err.size() - 1) << render.err;
}

}  // namespace
}  // namespace earthshine
