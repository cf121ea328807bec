// The benchmark's rows: one for each kernel, and a few that run, on a picture of 64 x 36.

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "image/temp_folder.hpp"

namespace earthshine::bench {
namespace {

using testing::HasSubstr;

test::Result runBench(const std::vector<std::string>& arguments) {
    return test::runEarthshine(arguments, {}, EARTHSHINE_BENCH_PATH);
}

TEST(BenchRows, EveryKernelHasOne) {
    const test::Result list = runBench({"--benchmark_list_tests"});
    ASSERT_EQ(list.exitCode, 0) << list.err;
    for (const auto& entry : std::filesystem::directory_iterator(EARTHSHINE_KERNEL_DIR)) {
        if (entry.path().extension() != ".cl") continue;
        const std::string kernel = entry.path().stem().string();
        EXPECT_THAT(list.out,
                    testing::ContainsRegex(fmt::format("(^|\n){}\\.[0-9]+x[0-9]+\\.([a-zA-Z0-9_]+\\.)*tuned", kernel)));
    }
}

TEST(BenchRows, AFewRun) {
    const test::TempFolder folder;
    const std::string file = (folder.path() / "few.json").string();
    const test::Result result =
        runBench({"--variants=tuned", "--sizes=64x36", "--benchmark_min_time=0.0001", "--benchmark_out=" + file,
                  "--benchmark_filter=^(copy.64x36.kernel|modulate.64x36.plain|atrous.64x36.row_step1|"
                  "rsm_gather.64x36.8spp|indirect.64x36.fast.1spp|frame.64x36.fast.1spp)\\.tuned"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    std::ifstream in(file);
    const nlohmann::json json = nlohmann::json::parse(in);
    for (const char* key : {"device", "platform", "driver", "lanes", "storage", "local_size", "timer", "revision",
                            "copy_GB/s", "fma_GFLOP/s"})
        EXPECT_NE(json["context"].value(key, ""), "") << key;
    ASSERT_EQ(json["benchmarks"].size(), 6u);
    for (const auto& row : json["benchmarks"]) {
        const std::string name = row["name"];
        EXPECT_GT(row.value("median_ms", 0.0), 0.0) << name;
        EXPECT_LE(row.value("min_ms", 0.0), row.value("median_ms", 0.0)) << name;
        EXPECT_THAT(result.out, HasSubstr(fmt::format("\n{} ", name.substr(0, name.find('/')))));
        if (name.starts_with("indirect") || name.starts_with("frame")) {
            EXPECT_GT(row.value("stage_ms:rsm_gather", 0.0), 0.0) << name;
            EXPECT_GT(row.value("wall_ms", 0.0), 0.0) << name;
            EXPECT_GT(row.value("bytes/px", 0.0), 0.0) << name;
            EXPECT_GT(row.value("ns/px", 0.0), 0.0) << name;
        } else {
            EXPECT_GT(row.value("GB/s", 0.0), 0.0) << name;
            EXPECT_GT(row.value("roofline", 0.0), 0.0) << name;
        }
    }
}

// Aggregates of repetitions are written as well, with NaN where Google Benchmark divides 0 by 0.
TEST(BenchRows, WhatARunWritesCompareReads) {
    const test::TempFolder folder;
    const std::string file = (folder.path() / "copies.json").string();
    const test::Result result =
        runBench({"--variants=tuned", "--sizes=64x36", "--benchmark_min_time=0.0001", "--benchmark_repetitions=3",
                  "--benchmark_filter=^copy", "--benchmark_out=" + file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const test::Result compared = runBench({"--compare", file, file});
    EXPECT_EQ(compared.exitCode, 0) << compared.err;
    EXPECT_THAT(compared.out, testing::ContainsRegex("copy.64x36.kernel.tuned.* 1\\.000 .*3 and 3\n"));
}

TEST(BenchRows, WrongUsageIsOneLine) {
    for (const auto& [argument, complaint] : std::vector<std::pair<std::string, std::string>>{
             {"--sizes=64", "sizes: '64' is not WIDTHxHEIGHT"},
             {"--sizes=0x5", "sizes: '0x5' is not WIDTHxHEIGHT"},
             {"--sizes=", "sizes: names none"},
             {"--variants=quick", "variants: 'quick' is none of tuned, naive, all"},
             {"--device=no such", "nothing here has the number or name 'no such'"},
             {"--tables", "'--tables' is no option"},
             {"--benchmark_format=json", "--benchmark_out=FILE.json"}}) {
        const test::Result result = runBench({argument, "--benchmark_list_tests"});
        EXPECT_EQ(result.exitCode, 2) << argument;
        EXPECT_THAT(result.err, HasSubstr(complaint));
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
}

}  // namespace
}  // namespace earthshine::bench
