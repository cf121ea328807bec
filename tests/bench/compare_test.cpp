// earthshine_bench --compare: two runs' ratios, and files that are none.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "bench/compare.hpp"
#include "cli/process.hpp"
#include "earthshine/error.hpp"
#include "image/temp_folder.hpp"

namespace earthshine::bench {
namespace {

using testing::HasSubstr;

const std::string kBefore = EARTHSHINE_BENCH_DATA "/before.json";
const std::string kAfter = EARTHSHINE_BENCH_DATA "/after.json";
const std::string kCutOff = EARTHSHINE_BENCH_DATA "/cut_off.json";

test::Result compareProgram(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "--compare");
    return test::runEarthshine(arguments, {}, EARTHSHINE_BENCH_PATH);
}

// Fails, in one line that holds `complaint`, with nothing on stdout.
void expectRefusal(const test::Result& result, int exitCode, const std::string& complaint) {
    EXPECT_EQ(result.exitCode, exitCode);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(complaint));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST(BenchCompare, RatiosOfMediansAndTheirQuartiles) {
    const auto rows = compareRows(readResultFile(kBefore), readResultFile(kAfter));
    ASSERT_EQ(rows.size(), 3u);  // those that both have
    EXPECT_EQ(rows[0].name, "atrous.64x36.row_step1.tuned");
    EXPECT_DOUBLE_EQ(rows[0].msA, 4.0);
    EXPECT_DOUBLE_EQ(rows[0].msB, 2.0);
    EXPECT_DOUBLE_EQ(rows[0].ratio, 0.5);
    // 1.9, 2.0, 2.1 over 3.8, 4.0, 4.2, sorted: 0.452 0.475 0.476 0.5 0.5 0.5 0.525 0.526 0.553
    EXPECT_DOUBLE_EQ(rows[0].low, 2.0 / 4.2);
    EXPECT_DOUBLE_EQ(rows[0].high, 2.1 / 4.0);
    EXPECT_EQ(rows[0].repetitionsA, 3u);
    EXPECT_EQ(rows[2].name, "temporal.64x36.still.tuned");
    EXPECT_DOUBLE_EQ(rows[2].ratio, 1.5);
    EXPECT_DOUBLE_EQ(rows[2].low, 1.5);  // of one repetition each
    EXPECT_DOUBLE_EQ(rows[2].high, 1.5);
}

TEST(BenchCompare, PrintsATable) {
    const test::Result result = compareProgram({kBefore, kAfter});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("revision v1"));
    EXPECT_THAT(result.out,
                testing::ContainsRegex("atrous.*4\\.0000.*2\\.0000.*0\\.500.*0\\.476 to 0\\.525.*3 and 3\n"));
    EXPECT_THAT(result.out, testing::ContainsRegex("temporal[^\n]*1 and 1\n"));
    EXPECT_THAT(result.out, HasSubstr("1 row only in " + kBefore));
    EXPECT_THAT(result.out, HasSubstr("1 row only in " + kAfter));
    EXPECT_THAT(result.out, HasSubstr(kAfter + ": rsm_sum.160x90.128px.tuned did not run"));
}

TEST(BenchCompare, RefusesWrongUsage) {
    expectRefusal(compareProgram({kBefore}), 2, "takes two files");
    expectRefusal(compareProgram({kBefore, kAfter, "--other"}), 2, "takes two files");
}

TEST(BenchCompare, RefusesWhatIsNoResult) {
    expectRefusal(compareProgram({kBefore, "nowhere.json"}), 1, "nowhere.json: cannot be read");
    expectRefusal(compareProgram({kCutOff, kBefore}), 1, "cut_off.json: is not JSON: wrong or cut off at byte 701");
}

/// after.json with a change.
class BenchCompareChanged : public testing::Test {
protected:
    template <class Change>
    std::string changed(Change&& change) {
        std::ifstream in(kAfter);  // which holds no NaN, unlike before.json
        nlohmann::json json = nlohmann::json::parse(in);
        change(json);
        const std::string path = (folder.path() / "changed.json").string();
        std::ofstream(path) << json;
        return path;
    }
    test::TempFolder folder;
};

TEST_F(BenchCompareChanged, NoContext) {
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json.erase("context"); })}), 1,
                  "changed.json: is not of earthshine_bench");
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json = nlohmann::json::array(); })}), 1,
                  "changed.json: is not of earthshine_bench");
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json["context"].erase("device"); })}), 1,
                  "names no device");
}

TEST_F(BenchCompareChanged, RowsThatAreNone) {
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json["benchmarks"][0] = 3; })}), 1,
                  "changed.json: benchmarks[0]: is not an object");
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json["benchmarks"][1].erase("name"); })}), 1,
                  "benchmarks[1]: has no name");
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json["benchmarks"][0].erase("median_ms"); })}), 1,
                  "benchmarks[0]: atrous.64x36.row_step1.tuned: has no median_ms");
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json["benchmarks"][0]["median_ms"] = 0; })}), 1,
                  "median_ms is 0, must be > 0");
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json["benchmarks"][0]["median_ms"] = "2"; })}), 1,
                  "has no median_ms");
}

TEST_F(BenchCompareChanged, NothingToCompare) {
    expectRefusal(compareProgram({kBefore, changed([](auto& json) { json["benchmarks"].clear(); })}), 1,
                  "holds no row that ran");
    expectRefusal(compareProgram({kBefore, changed([](auto& json) {
                                      for (auto& row : json["benchmarks"]) row["name"] = "other";
                                  })}),
                  1, "no row in common");
}

TEST_F(BenchCompareChanged, OtherDevices) {
    const std::string other = changed([](auto& json) { json["context"]["device"] = "another device"; });
    expectRefusal(compareProgram({kBefore, other}), 1, "is of \"a device\"");
    const test::Result result = compareProgram({kBefore, other, "--any-device"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("another device"));
}

}  // namespace
}  // namespace earthshine::bench
