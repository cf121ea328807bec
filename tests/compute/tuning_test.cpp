// The tuning table: what its rows say, in which order they are asked, and that launches heed them.

#include "compute/tuning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <sstream>

#include "compute/kernel.hpp"
#include "compute/tuning_table.hpp"
#include "earthshine/error.hpp"
#include "earthshine/pipeline.hpp"
#include "image/temp_folder.hpp"
#include "reference/device_variants.hpp"
#include "reference/synthetic_frame.hpp"

namespace earthshine {
namespace {

using test::TempFolder;
using test::thrown;
using test::writeText;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<TuningRow> rowsOf(const std::string& text) {
    std::istringstream lines(text);
    return parseTuning(lines, "t");
}

DeviceCaps fastGpu() {
    DeviceCaps caps;
    caps.name = "Fast GPU 3000";
    caps.vendor = "Maker Inc.";
    caps.platformName = "Maker OpenCL";
    caps.type = "GPU";
    caps.images = true;
    caps.imageFormats = {"R32F", "RGBA16F", "RGBA32F", "RGBA8"};
    caps.maxWorkGroupSize = 1024;
    return caps;
}

std::array<int, 2> groupOf(const std::string& table, const DeviceCaps& caps, const std::string& kernel) {
    return localSizeOf(lookUpTuning(rowsOf(table), caps), kernel);
}

TEST(TuningTable, FallsBackFromDeviceToDefault) {
    // From the last scope to the first, so that the order of lines cannot be what decides.
    const std::string rows[] = {"default * * 1 planar 1x1", "type GPU * 4 image 2x1", "vendor maker * 8 planar 3x1",
                                "platform \"maker opencl\" * 16 image 4x1", "device \"GPU 3000\" * 1 planar 5x1"};
    const int lanes[] = {1, 4, 8, 16, 1};
    std::string table;
    for (int i = 0; i < 5; ++i) {
        table += rows[i] + "\n";
        const Tuning tuning = lookUpTuning(rowsOf(table), fastGpu());
        EXPECT_EQ(tuning.lanes, lanes[i]) << table;
        EXPECT_EQ(tuning.storage, i % 2 == 0 ? Storage::Planar : Storage::Image) << table;
        EXPECT_THAT(localSizeOf(tuning, "atrous"), ElementsAre(i + 1, 1)) << table;
    }
    EXPECT_EQ(lookUpTuning(rowsOf(table), fastGpu()).reason, "t, device GPU 3000");
    DeviceCaps other;
    other.name = "Slow";
    other.type = "CPU";
    EXPECT_THAT(groupOf(table, other, "atrous"), ElementsAre(1, 1));
    EXPECT_EQ(lookUpTuning(rowsOf(table), other).reason, "t, default");
}

TEST(TuningTable, AValueLeftOpenIsTheNextRows) {
    const std::string table = "default * * 1 planar 16x8\ntype GPU * 4 - -\ndevice fast * - image -\n";
    const Tuning tuning = lookUpTuning(rowsOf(table), fastGpu());
    EXPECT_EQ(tuning.lanes, 4);
    EXPECT_EQ(tuning.storage, Storage::Image);
    EXPECT_THAT(localSizeOf(tuning, "atrous"), ElementsAre(16, 8));
}

TEST(TuningTable, AKernelsOwnRowGoesBeforeThatOfAllInOneScopeOnly) {
    const std::string kernel = "type GPU atrous - - 4x2\n", all = "type GPU * - - 8x8\n";
    for (const std::string& table : {kernel + all, all + kernel}) {
        EXPECT_THAT(groupOf(table, fastGpu(), "atrous"), ElementsAre(4, 2));
        EXPECT_THAT(groupOf(table, fastGpu(), "temporal"), ElementsAre(8, 8));
        // What is known of the device goes before what is known of its type.
        EXPECT_THAT(groupOf(table + "device fast * - - 32x1", fastGpu(), "atrous"), ElementsAre(32, 1));
        EXPECT_THAT(groupOf(table + "device fast temporal - - 32x1", fastGpu(), "temporal"), ElementsAre(32, 1));
    }
    // Of two rows that fit as well, the first.
    EXPECT_THAT(groupOf("device fast * - - 3x1\ndevice 3000 * - - 5x1", fastGpu(), "atrous"), ElementsAre(3, 1));
}

TEST(TuningTable, NativeLanesFollowTheDevice) {
    for (const auto& [width, lanes] : {std::pair{1, 4}, {4, 4}, {8, 8}, {16, 16}, {32, 16}}) {
        DeviceCaps caps;
        caps.nativeFloatWidth = width;
        EXPECT_EQ(lookUpTuning(rowsOf("default * * native planar 1x1"), caps).lanes, lanes);
    }
}

TEST(TuningTable, RefusesWhatIsNoRowAndNamesTheLine) {
    const auto message = [](const std::string& line) {
        return thrown<InputError>([&] { rowsOf("# a comment\n\ntype CPU * 16 planar 64x4  # and one more\n" + line); });
    };
    EXPECT_THAT(message("type CPU * 16 planar"), testing::StartsWith("t:4: 5 columns, must be 6"));
    EXPECT_THAT(message("type CPU * 16 planar 64x4 more"), HasSubstr("7 columns"));
    EXPECT_THAT(message("device \"no end * 16 planar 64x4"), HasSubstr("columns"));
    EXPECT_THAT(message("driver CPU * 16 planar 64x4"), HasSubstr("scope 'driver'"));
    EXPECT_THAT(message("default CPU * 16 planar 64x4"), HasSubstr("pattern 'CPU'"));
    EXPECT_THAT(message("type * * 16 planar 64x4"), HasSubstr("pattern '*'"));
    EXPECT_THAT(message("type CPU rsm_gahter - - 64x4"), HasSubstr("no kernel 'rsm_gahter'"));
    EXPECT_THAT(message("type CPU rsm_gather 16 - 64x4"), HasSubstr("rsm_gather's own row"));
    EXPECT_THAT(message("type CPU * 3 planar 64x4"), HasSubstr("lanes '3'"));
    EXPECT_THAT(message("type CPU * -1 planar 64x4"), HasSubstr("lanes '-1'"));
    EXPECT_THAT(message("type CPU * 16 tape 64x4"), HasSubstr("storage 'tape'"));
    for (const char* group : {"64", "64x", "x4", "0x4", "64x-4", "64x4x1", "64*4", "99999999999x1", "4097x1"})
        EXPECT_THAT(message(std::string("type CPU * 16 planar ") + group), HasSubstr(std::string("group '") + group));
}

TEST(TuningTable, RowsReadAsTheyAreWritten) {
    const std::string lines[] = {"device \"a name # with\" * native planar 64x4", "type GPU rsm_gather - - 16x2",
                                 "default * * 4 - -"};
    for (const std::string& line : lines) {
        const TuningRow row = rowsOf(line).at(0);
        const TuningRow again = rowsOf(tuningHeading() + "\n" + formatTuningRow(row)).at(0);
        EXPECT_EQ(again.scope, row.scope);
        EXPECT_EQ(again.pattern, row.pattern);
        EXPECT_EQ(again.kernel, row.kernel);
        EXPECT_EQ(again.lanes, row.lanes);
        EXPECT_EQ(again.storage, row.storage);
        EXPECT_THAT(again.localSizePx, ElementsAre(row.localSizePx[0], row.localSizePx[1]));
    }
}

TEST(TuningTable, ShippedRowsHoldEveryDevice) {
    const Tuning gpu = defaultTuning(fastGpu());
    EXPECT_EQ(gpu.lanes, 1);
    EXPECT_EQ(gpu.storage, Storage::Image);
    EXPECT_THAT(localSizeOf(gpu, "atrous"), ElementsAre(16, 8));
    EXPECT_EQ(gpu.reason, "shipped table, default: 1 pixel a work-item, images");
    DeviceCaps cpu = fastGpu();
    cpu.type = "CPU";
    cpu.nativeFloatWidth = 8;
    EXPECT_EQ(defaultTuning(cpu).lanes, 8);
    EXPECT_EQ(defaultTuning(cpu).storage, Storage::Planar);
    EXPECT_THAT(localSizeOf(defaultTuning(cpu), "atrous"), ElementsAre(128, 4));
    EXPECT_THAT(localSizeOf(defaultTuning(cpu), "unpack"), ElementsAre(64, 1));
    cpu.name = "llvmpipe (LLVM 15.0.6, 256 bits)";
    EXPECT_EQ(defaultTuning(cpu).lanes, 1);
    EXPECT_THAT(localSizeOf(defaultTuning(cpu), "unpack"), ElementsAre(8, 8));
    DeviceCaps noImages = fastGpu();
    noImages.imageFormats = {"RGBA8"};
    EXPECT_EQ(defaultTuning(noImages).storage, Storage::Planar);
    DeviceCaps small = fastGpu();
    small.maxWorkGroupSize = 12;
    EXPECT_THAT(localSizeOf(defaultTuning(small), "atrous"), ElementsAre(12, 1));
}

TEST(TuningTable, AUsersFileGoesBeforeTheShippedRowsAndOptionsBeforeIt) {
    const TempFolder folder;
    const std::string path = (folder / "own.tuning").string();
    writeText(path, "default * * 8 planar 32x2\ndefault * atrous - - 4x4\n");
    DeviceCaps cpu = fastGpu();
    cpu.type = "CPU";  // of which the shipped table has a row of closer scope
    cpu.nativeFloatWidth = 16;
    DeviceOptions options;
    options.tuningFile = path;
    const Tuning own = tuningFor(cpu, options);
    EXPECT_EQ(own.lanes, 8);
    EXPECT_THAT(localSizeOf(own, "temporal"), ElementsAre(32, 2));
    EXPECT_THAT(localSizeOf(own, "atrous"), ElementsAre(4, 4));
    EXPECT_THAT(own.reason, HasSubstr("own.tuning, default"));

    ::setenv("EARTHSHINE_TUNING", path.c_str(), 1);
    EXPECT_EQ(tuningFor(cpu, {}).lanes, 8);
    ::unsetenv("EARTHSHINE_TUNING");
    EXPECT_EQ(tuningFor(cpu, {}).lanes, 16);

    options.lanes = 1;
    options.storage = "image";
    options.localSizePx[0] = 2;
    options.localSizePx[1] = 3;
    const Tuning asked = tuningFor(cpu, options);
    EXPECT_EQ(asked.lanes, 1);
    EXPECT_EQ(asked.storage, Storage::Image);
    EXPECT_THAT(localSizeOf(asked, "atrous"), ElementsAre(2, 3));

    options.tuningFile = (folder / "none.tuning").string();
    EXPECT_THAT(thrown<InputError>([&] { tuningFor(cpu, options); }), HasSubstr("none.tuning: cannot be opened"));
    options.tuningFile = folder.path().string();
    EXPECT_THAT(thrown<InputError>([&] { tuningFor(cpu, options); }), HasSubstr("cannot be read"));
}

/// A device with groups of its own for two kernels and the rest: the frame is the same, to the bit, since the order of
/// a kernel's sums does not depend on its groups; and OpenCL was told so.
class TunedGroups : public testing::TestWithParam<reference::Variant> {};

TEST_P(TunedGroups, AreThoseOfLaunchesAndChangeNoResult) {
    const TempFolder folder;
    const std::string path = (folder / "groups.tuning").string();
    writeText(path, "default * * - - 4x2\ndefault * rsm_gather - - 2x8\ndefault * atrous - - 16x1\n");
    const FrameImages images = reference::makeSyntheticFrame();
    const auto frameOf = [&](const DeviceOptions& options) {
        Pipeline pipeline{Device(GetParam().caps, options)};
        pipeline.setFrame(images.inputs());
        pipeline.run(settingsOf(Preset::Balanced));
        return pipeline.read(Output::Color);
    };
    DeviceOptions tuned = GetParam().options;
    tuned.tuningFile = path;
    const HostImage expected = frameOf(GetParam().options), actual = frameOf(tuned);
    EXPECT_EQ(std::memcmp(expected.data(), actual.data(), expected.sizeBytes()), 0);

    const Device device(GetParam().caps, tuned);
    EXPECT_THAT(Kernel(device, "rsm_gather").localSize(), ElementsAre(2, 8));
    EXPECT_THAT(Kernel(device, "atrous").localSize(), ElementsAre(16, 1));
    EXPECT_THAT(Kernel(device, "temporal").localSize(), ElementsAre(4, 2));
}

INSTANTIATE_TEST_SUITE_P(All, TunedGroups, testing::ValuesIn(reference::defaultVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
