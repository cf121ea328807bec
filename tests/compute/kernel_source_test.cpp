// Kernel texts: includes in place, names of arguments.

#include "compute/kernel_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "compute/kernel.hpp"
#include "compute/program_cache.hpp"
#include "earthshine/error.hpp"
#include "image/temp_folder.hpp"
#include "reference/device_variants.hpp"

namespace earthshine {
namespace {

using test::TempFolder;
using test::thrown;
using test::writeText;
using testing::HasSubstr;
using Names = std::vector<std::string>;

Names allKernels() {
    Names names;
    for (const KernelText* text = kKernelTexts; text->name; ++text) {
        const std::string name = text->name;
        if (name.ends_with(".cl")) names.push_back(name.substr(0, name.size() - 3));
    }
    return names;
}

int countOf(const std::string& text, const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(KernelSource, TheLibraryHoldsWhatTheFolderHolds) {
    EXPECT_GE(allKernels().size(), 10u);
    for (const std::string& name : allKernels())
        EXPECT_EQ(expandKernel(name + ".cl", ""), expandKernel(name + ".cl", EARTHSHINE_KERNEL_DIR)) << name;
}

TEST(KernelSource, EachIncludeIsThereOnce) {
    for (const std::string& name : allKernels()) {
        const std::string text = expandKernel(name + ".cl", "");
        EXPECT_EQ(countOf(text, "#include \""), 0) << name;
        EXPECT_EQ(countOf(text, "#define EARTHSHINE_SHARED_DIALECT_H"), 1) << name;
        EXPECT_EQ(countOf(text, "__kernel void " + name + "("), 1) << name;
    }
}

TEST(KernelSource, LineMarksKeepFilesAndLines) {
    const TempFolder folder;
    std::filesystem::create_directory(folder / "common");
    std::filesystem::create_directory(folder / "shared");
    writeText(folder / "a.cl", "one\n#include \"b.clh\"\nthree\n#include \"b.clh\"\nfive\n");
    writeText(folder / "common" / "b.clh", "b one\n#include \"c.h\"\nb three\n");
    writeText(folder / "shared" / "c.h", "#include \"b.clh\"\nc two");  // a circle, and no line end
    EXPECT_EQ(expandKernel("a.cl", folder.path().string()),
              "#line 1 \"a.cl\"\none\n"
              "#line 1 \"b.clh\"\nb one\n"
              "#line 1 \"c.h\"\n#line 2 \"c.h\"\nc two\n"
              "#line 3 \"b.clh\"\nb three\n"
              "#line 3 \"a.cl\"\nthree\n"
              "#line 5 \"a.cl\"\nfive\n");
}

TEST(KernelSource, MessagesOfTheWholeTextGetFilesAndLines) {
    const std::string text =
        "#line 1 \"a.cl\"\none\n"
        "#line 1 \"b.clh\"\nb one\n"
        "#line 3 \"b.clh\"\nb three\nb four\n"
        "#line 3 \"a.cl\"\nthree\n";
    EXPECT_EQ(withFilesAndLines("<kernel>:2:7: error: x\n<kernel>:7:1: note: y\n  ^\n", text),
              "a.cl:1:7: error: x\nb.clh:4:1: note: y\n  ^\n");
    EXPECT_EQ(withFilesAndLines("<kernel>:9:1: end", text), "a.cl:3:1: end");
    // What is no such place stays.
    for (const char* log : {"", "<kernel>:", "<kernel>:10:1: beyond", "<kernel>:0:", "<kernel>: x", "b.clh:3:1: known",
                            "<kernel>:99999999999999999999999:"})
        EXPECT_EQ(withFilesAndLines(log, text), log);
}

TEST(KernelSource, ATextOfAnotherIncludesTheLibrarys) {
    const std::string text = expandKernelText("own.cl", "#include \"lanes.clh\"\ntwo\n", "");
    EXPECT_TRUE(text.starts_with("#line 1 \"own.cl\"\n#line 1 \"lanes.clh\"\n"));
    EXPECT_TRUE(text.ends_with("#line 2 \"own.cl\"\ntwo\n"));
    EXPECT_EQ(countOf(text, "#define EARTHSHINE_LANES_CLH"), 1);
    EXPECT_THAT(thrown<InputError>([] { expandKernelText("own.cl", "\n#include \"nowhere.clh\"\n", ""); }),
                HasSubstr("own.cl:2: nowhere.clh"));
}

TEST(KernelSource, WhatIsMissingIsNamed) {
    const TempFolder folder;
    writeText(folder / "a.cl", "one\n\n#include \"nowhere.clh\"\n");
    writeText(folder / "b.cl", "#include \"open\n");
    const std::string path = folder.path().string();
    EXPECT_THAT(thrown<InputError>([&] { expandKernel("a.cl", path); }),
                testing::AllOf(HasSubstr("a.cl:3: nowhere.clh"), HasSubstr(path)));
    EXPECT_THAT(thrown<InputError>([&] { expandKernel("b.cl", path); }), HasSubstr("b.cl:1"));
    EXPECT_THAT(thrown<InputError>([&] { expandKernel("none.cl", path); }), HasSubstr("none.cl"));
    EXPECT_THAT(thrown<InputError>([] { expandKernel("none.cl", ""); }), HasSubstr("in the library"));
    EXPECT_THAT(thrown<InputError>([] { argumentNames("__kernel void a()", "b", true); }), HasSubstr("b.cl"));
}

TEST(KernelSource, ArgumentNamesInOrder) {
    const std::string text =
        "__kernel void k(SURFACE_IN(inDepth), RSM_IN(rsm),\n"
        "                __global const LightParams* restrict lights, SURFACE_OUT(outColor),\n"
        "                __global float4* a, const Params params) {}";
    EXPECT_EQ(argumentNames(text, "k", true),
              (Names{"inDepth", "inDepthLayout", "rsm", "lights", "outColor", "outColorLayout", "a", "params"}));
    EXPECT_EQ(
        argumentNames("__kernel void k(RSM_IN(rsm), int n)", "k", false),
        (Names{"rsmDepth", "rsmDepthLayout", "rsmNormalWs", "rsmNormalWsLayout", "rsmFlux", "rsmFluxLayout", "n"}));
}

// What we read out of the text is what the driver says, for every kernel and every way to build it.
TEST(KernelSource, ArgumentNamesAreTheDrivers) {
    int compared = 0;
    for (const reference::Variant& variant : reference::allVariants()) {
        if (variant.options.lanes != 1) continue;  // the width changes no argument
        const bool hasRecords = variant.options.rsmRecords != 0;
        const Device device(variant.caps, variant.options);
        for (const std::string& name : allKernels()) {
            SCOPED_TRACE(variant.name + ": " + name);
            const std::string text = expandKernel(name + ".cl", "");
            const std::string options =
                std::string("-cl-std=CL1.2 -cl-kernel-arg-info -DES_DIALECT_CL -DLANES=1 -DSTORAGE=") +
                std::to_string(int(device.tuning().storage)) + " -DRSM_RECORDS=" + (hasRecords ? "1" : "0");
            const cl::Program program =
                buildProgram(device.impl().context, device.impl().device, name, text, options, "");
            const cl::Kernel kernel(program, name.c_str());
            const Names names = argumentNames(text, name, hasRecords);
            ASSERT_EQ(names.size(), kernel.getInfo<CL_KERNEL_NUM_ARGS>());
            for (std::size_t i = 0; i < names.size(); ++i) {
                std::string driverName;
                try {
                    driverName = kernel.getArgInfo<CL_KERNEL_ARG_NAME>(cl_uint(i));
                } catch (const cl::Error& error) {
                    // Drivers may leave this out; one of those here must not.
                    ASSERT_EQ(error.err(), CL_KERNEL_ARG_INFO_NOT_AVAILABLE);
                    break;
                }
                EXPECT_EQ(driverName, names[i]);
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 0);
}

}  // namespace
}  // namespace earthshine
