// Outputs appear whole or not at all.

#include "image/output_set.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "earthshine/error.hpp"
#include "temp_folder.hpp"

namespace fs = std::filesystem;

namespace earthshine {
namespace {

using test::readText;
using test::TempFolder;
using test::thrown;
using test::writeText;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(OutputSet, NothingAppearsBeforeCommitAndAllAfter) {
    const TempFolder folder;
    writeText(folder / "a.txt", "old");
    {
        OutputSet outputs;
        writeText(outputs.addFile(folder / "a.txt"), "new");
        const fs::path inner = outputs.addFolder(folder / "in", "mark");
        writeText(inner / "mark", "");
        EXPECT_EQ(readText(folder / "a.txt"), "old");
        EXPECT_FALSE(fs::exists(folder / "in"));
        outputs.commit();
    }
    EXPECT_THAT(folder.names(), ElementsAre("a.txt", "in"));
    EXPECT_EQ(readText(folder / "a.txt"), "new");
    EXPECT_TRUE(fs::exists(folder / "in/mark"));
}

TEST(OutputSet, WithoutCommitEverythingIsAsBefore) {
    const TempFolder folder;
    writeText(folder / "a.txt", "old");
    {
        OutputSet outputs;
        writeText(outputs.addFile(folder / "a.txt"), "half");
        writeText(outputs.addFolder(folder / "in", "mark") / "mark", "half");
        outputs.addFile(folder / "b.txt");
    }
    EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
    EXPECT_EQ(readText(folder / "a.txt"), "old");
}

TEST(OutputSet, DiscardAllRemovesWhatOpenSetsHold) {
    const TempFolder folder;
    OutputSet outputs;
    const fs::path temporary = outputs.addFile(folder / "a.txt");
    outputs.addFolder(folder / "in", "mark");
    EXPECT_EQ(folder.names().size(), 2u);
    writeText(temporary, "half");
    OutputSet::discardAll();
    EXPECT_THAT(folder.names(), IsEmpty());
    // Nor can a writer that had the path, and not opened it yet, make it anew.
    EXPECT_FALSE(std::ofstream(temporary).is_open());
    EXPECT_THAT(folder.names(), IsEmpty());
    outputs.commit();
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(OutputSet, OnePathOnce) {
    const TempFolder folder;
    fs::create_directory(folder / "sub");
    OutputSet outputs;
    outputs.addFile(folder / "a.txt");
    EXPECT_THAT(thrown<UsageError>([&] { outputs.addFile(folder / "sub/../a.txt"); }), HasSubstr("two outputs"));
    EXPECT_THAT(thrown<UsageError>([&] { outputs.addFolder(folder / "a.txt/", "mark"); }), HasSubstr("two outputs"));
}

TEST(OutputSet, WhatCannotBeWrittenIsRefusedAtOnce) {
    const TempFolder folder;
    fs::create_directory(folder / "sub");
    writeText(folder / "file", "");
    OutputSet outputs;
    EXPECT_THAT(thrown<Error>([&] { outputs.addFile(folder / "no/a.txt"); }), HasSubstr("there is no folder"));
    EXPECT_THAT(thrown<Error>([&] { outputs.addFile(folder / "file/a.txt"); }), HasSubstr("there is no folder"));
    EXPECT_THAT(thrown<Error>([&] { outputs.addFile(folder / "sub"); }), HasSubstr("is no file"));
    EXPECT_THAT(thrown<Error>([&] { outputs.addFile("/dev/null"); }), HasSubstr("is no file"));
    // Not even root makes files there.
    EXPECT_THAT(thrown<Error>([&] { outputs.addFile("/proc/a.txt"); }), HasSubstr("cannot be written"));
    EXPECT_THAT(thrown<UsageError>([&] { outputs.addFile(""); }), HasSubstr("not the name"));
    EXPECT_THAT(thrown<Error>([&] { outputs.addFolder(folder / "file", "mark"); }), HasSubstr("is no folder"));
    EXPECT_TRUE(outputs.paths().empty());
}

TEST(OutputSet, OnlyFoldersOfTheirKindAreReplaced) {
    const TempFolder folder;
    fs::create_directory(folder / "mine");
    writeText(folder / "mine/precious", "");
    OutputSet outputs;
    EXPECT_THAT(thrown<Error>([&] { outputs.addFolder(folder / "mine", "mark"); }), HasSubstr("holds other things"));

    writeText(folder / "mine/mark", "old");
    writeText(outputs.addFolder(folder / "mine", "mark") / "mark", "new");
    fs::create_directory(folder / "empty");
    writeText(outputs.addFolder(folder / "empty", "mark") / "mark", "new");
    outputs.commit();
    EXPECT_EQ(readText(folder / "mine/mark"), "new");
    EXPECT_FALSE(fs::exists(folder / "mine/precious"));
    EXPECT_EQ(readText(folder / "empty/mark"), "new");
    EXPECT_THAT(folder.names(), ElementsAre("empty", "mine"));
}

TEST(OutputSet, ALinkStaysALink) {
    const TempFolder folder;
    writeText(folder / "target", "old");
    fs::create_symlink("target", folder / "link");
    OutputSet outputs;
    writeText(outputs.addFile(folder / "link"), "new");
    outputs.commit();
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(readText(folder / "target"), "new");
}

}  // namespace
}  // namespace earthshine
