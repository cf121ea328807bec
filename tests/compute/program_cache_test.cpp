// Compiled programs on disk: used when they are the same in full, rebuilt when they are damaged, never in the way.

#include "compute/program_cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "compute/kernel.hpp"
#include "compute/quirks.hpp"
#include "earthshine/error.hpp"
#include "earthshine/log.hpp"
#include "earthshine/pipeline.hpp"
#include "reference/device_variants.hpp"
#include "reference/synthetic_frame.hpp"
#include "support/kernel_folder.hpp"

namespace earthshine {
namespace {

using test::readText;
using test::TempFolder;
using test::writeText;

constexpr const char* kOptions = "-cl-std=CL1.2";

std::string sourceThatWrites(int value) {
    return "__kernel void answer(__global int* out) { *out = " + std::to_string(value) + "; }";
}

/// The parts of an entry that a test takes apart: a header of four 64-bit numbers, the key's text, the binary.
struct Entry {
    std::string header, key, binary;

    static Entry read(const std::filesystem::path& path) {
        const std::string bytes = readText(path);
        const std::size_t keyBytes = numberOf(bytes, 1);
        return {bytes.substr(0, 32), bytes.substr(32, keyBytes), bytes.substr(32 + keyBytes)};
    }
    void write(const std::filesystem::path& path) const { writeText(path, header + key + binary); }
    static std::size_t numberOf(const std::string& header, int i) {
        std::uint64_t value = 0;
        std::memcpy(&value, header.data() + 8 * i, 8);
        return value;
    }
    /// A binary that is none, in an entry that is sound in itself.
    static Entry nonsense(Entry entry) {
        entry.binary = std::string(1000, 'x');
        entry.setNumber(2, entry.binary.size());
        std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, as the cache checks it
        for (unsigned char c : entry.binary) hash = (hash ^ c) * 0x100000001b3ull;
        entry.setNumber(3, hash);
        return entry;
    }
    void setNumber(int i, std::uint64_t value) { std::memcpy(header.data() + 8 * i, &value, 8); }
};

class ProgramCache : public testing::TestWithParam<reference::Variant> {
protected:
    // Builds through the cache and runs what comes out.
    int answerOf(const std::string& source, const std::string& folder) {
        Device::Impl& impl = device_.impl();
        const cl::Program program = buildProgram(impl.context, impl.device, "answer", source, kOptions, folder);
        cl::Kernel kernel(program, "answer");
        const cl::Buffer out = impl.makeBuffer(sizeof(int));
        kernel.setArg(0, out);
        impl.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
        int value = 0;
        impl.queue.enqueueReadBuffer(out, CL_TRUE, 0, sizeof value, &value);
        return value;
    }
    std::filesystem::path onlyEntry() const {
        EXPECT_EQ(folder_.names().size(), 1u);
        return folder_ / folder_.names().at(0);
    }

    Device device_{GetParam().caps, GetParam().options};
    TempFolder folder_;
    const std::string path_ = folder_.path().string();
};

TEST_P(ProgramCache, TheSecondBuildIsTheFirstOnesBinary) {
    EXPECT_EQ(answerOf(sourceThatWrites(1), path_), 1);
    const std::filesystem::path first = onlyEntry();
    // Another program's binary under the first one's key: only who takes it from the cache gets its answer.
    const TempFolder other;
    EXPECT_EQ(answerOf(sourceThatWrites(2), other.path().string()), 2);
    const Entry second = Entry::read(other / other.names().at(0));
    Entry forged = Entry::read(first);
    forged.binary = second.binary;
    forged.setNumber(2, second.binary.size());
    forged.setNumber(3, Entry::numberOf(second.header, 3));
    forged.write(first);
    EXPECT_EQ(answerOf(sourceThatWrites(1), path_), 2);
    // And nobody else: a different source has a different key.
    EXPECT_EQ(answerOf(sourceThatWrites(3), path_), 3);
    EXPECT_EQ(folder_.names().size(), 2u);
}

TEST_P(ProgramCache, DamagedEntriesAreWrittenAnew) {
    EXPECT_EQ(answerOf(sourceThatWrites(1), path_), 1);
    const std::filesystem::path path = onlyEntry();
    const std::string sound = readText(path);
    const Entry entry = Entry::read(path);

    std::vector<std::string> damaged = {"",
                                        "x",
                                        sound.substr(0, 31),
                                        sound.substr(0, 40),
                                        sound.substr(0, sound.size() / 2),
                                        sound.substr(0, sound.size() - 1)};
    std::string flipped = sound;
    flipped[sound.size() - 7] = char(flipped[sound.size() - 7] ^ 1);
    damaged.push_back(flipped);
    Entry huge = entry;  // a header that asks for more memory than there is
    huge.setNumber(2, ~0ull);
    damaged.push_back(huge.header + huge.key + huge.binary);
    huge.setNumber(1, ~0ull);
    damaged.push_back(huge.header + huge.key + huge.binary);
    Entry foreign = entry;  // sound, but for another key whose hash would be the same
    foreign.key.back() = char(foreign.key.back() ^ 1);
    damaged.push_back(foreign.header + foreign.key + foreign.binary);

    // A binary that the driver refuses. rusticl (Mesa 22.3) panics at one, so it gets none: the hash keeps them away.
    if (!runsOnLlvmpipe(device_.caps())) {
        const Entry refused = Entry::nonsense(entry);
        damaged.push_back(refused.header + refused.key + refused.binary);
    }

    for (std::size_t i = 0; i < damaged.size(); ++i) {
        SCOPED_TRACE(i);
        writeText(path, damaged[i]);
        EXPECT_EQ(answerOf(sourceThatWrites(1), path_), 1);
        EXPECT_EQ(Entry::read(onlyEntry()).key, entry.key);
        EXPECT_EQ(Entry::numberOf(readText(path), 2), Entry::read(path).binary.size());
    }
}

TEST_P(ProgramCache, ACacheThatCannotBeWrittenIsNoError) {
    // A folder below a file: nobody can make that, whatever their rights.
    writeText(folder_ / "file", "");
    const std::string below = (folder_ / "file").string() + "/folder";
    EXPECT_EQ(answerOf(sourceThatWrites(4), below), 4);
    EXPECT_EQ(answerOf(sourceThatWrites(4), below), 4);
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"file"});
}

TEST_P(ProgramCache, NoneWritesNothing) {
    EXPECT_EQ(cacheFolderFor("none"), "");
    EXPECT_EQ(answerOf(sourceThatWrites(5), cacheFolderFor("none")), 5);
    EXPECT_TRUE(folder_.names().empty());
}

// A changed include is a changed key (drivers with caches of their own have overlooked such changes).
TEST_P(ProgramCache, AChangedIncludeIsBuilt) {
    test::KernelFolder kernels;
    reference::Variant variant = GetParam();
    variant.options.kernelFolder = kernels.path();
    variant.options.cacheFolder = path_;
    Kernel(Device(variant.caps, variant.options), "modulate").build();
    const std::size_t entries = folder_.names().size();
    Kernel(Device(variant.caps, variant.options), "modulate").build();
    EXPECT_EQ(folder_.names().size(), entries);
    kernels.replace("common/math.clh", "#define ES_INV_PI 0.318309886183791f", "#define ES_INV_PI 0.25f");
    Kernel(Device(variant.caps, variant.options), "modulate").build();
    EXPECT_EQ(folder_.names().size(), entries + 1);
}

TEST_P(ProgramCache, AFailedBuildNamesFileAndLine) {
    test::KernelFolder kernels;
    kernels.replace("common/vec3.clh", "static vfloat3 add3(", "static vfloat3 add3(noSuchType planted, ");
    const std::string text = readText(std::filesystem::path(kernels.path()) / "common" / "vec3.clh");
    const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(text.find("planted")), '\n');
    reference::Variant variant = GetParam();
    variant.options.kernelFolder = kernels.path();
    variant.options.cacheFolder = path_;
    try {
        Kernel(Device(variant.caps, variant.options), "modulate").build();
        FAIL() << "it was built";
    } catch (const BuildError& error) {
        EXPECT_THAT(error.what(), testing::StartsWith("modulate.cl: "));
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        EXPECT_THAT(error.log(), testing::HasSubstr("vec3.clh:" + std::to_string(line)));
        EXPECT_THAT(error.log(), testing::HasSubstr("noSuchType"));
    }
    EXPECT_TRUE(folder_.names().empty());
}

/// The kernels that are compiled while it lives, in order, as the log tells of them.
class Compiled {
public:
    Compiled() {
        setLogSink([this](LogLevel level, std::string_view line) {
            constexpr std::string_view kBegin = "compiling kernel ";
            if (level != LogLevel::Progress) return;
            if (line.starts_with(kBegin)) names.emplace_back(line.substr(kBegin.size()));
            isOver = line.empty();
        });
    }
    ~Compiled() { setLogSink({}); }
    Compiled(const Compiled&) = delete;
    Compiled& operator=(const Compiled&) = delete;

    std::vector<std::string> names;
    bool isOver = false;
};

// Cold: only what a frame needs, each once, and said so. Warm: nothing.
TEST_P(ProgramCache, AFrameCompilesWhatItNeedsOnce) {
    const FrameImages images = reference::makeSyntheticFrame();
    reference::Variant variant = GetParam();
    variant.options.cacheFolder = path_;
    const auto compiledBy = [&](std::initializer_list<Settings> runs) {
        const Compiled compiled;
        Pipeline pipeline{Device(variant.caps, variant.options)};
        pipeline.setFrame(images.inputs());
        for (const Settings& settings : runs) pipeline.run(settings);
        EXPECT_EQ(compiled.isOver, !compiled.names.empty());
        return compiled.names;
    };
    const Settings plain = settingsOf(Preset::Still), denoised = settingsOf(Preset::Balanced);
    EXPECT_THAT(compiledBy({plain, plain}),
                testing::UnorderedElementsAre("unpack", "interleave", "direct_light", "rsm_pack", "rsm_gather",
                                              "modulate", "luminance_sum", "exposure", "tone_map"));
    EXPECT_THAT(compiledBy({plain, denoised}),
                testing::UnorderedElementsAre("rsm_gather", "temporal", "history_check", "history_confidence",
                                              "atrous_pair", "atrous_pair"));
    EXPECT_THAT(compiledBy({plain, denoised}), testing::IsEmpty());
    variant.options.cacheFolder = "none";
    // atrous_pair of two kinds in turn, each built once.
    EXPECT_THAT(compiledBy({denoised, denoised}), testing::SizeIs(14));
}

INSTANTIATE_TEST_SUITE_P(All, ProgramCache, testing::ValuesIn(reference::defaultVariants()),
                         [](const auto& variant) { return variant.param.name; });

/// Sets an environment variable, and puts it back.
class Environment {
public:
    Environment(const char* name, const char* value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before, wasSet_ = true;
        value ? ::setenv(name, value, 1) : ::unsetenv(name);
    }
    ~Environment() { wasSet_ ? ::setenv(name_, before_.c_str(), 1) : ::unsetenv(name_); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    const char* name_;
    std::string before_;
    bool wasSet_ = false;
};

TEST(ProgramCacheFolder, IsTheFirstThatIsSet) {
    const Environment home("HOME", "/h");
    {
        const Environment xdg("XDG_CACHE_HOME", "/x"), own("EARTHSHINE_CACHE", "/own");
        EXPECT_EQ(cacheFolderFor("/asked"), "/asked");
        EXPECT_EQ(cacheFolderFor(""), "/own");
    }
    {
        const Environment xdg("XDG_CACHE_HOME", "/x"), own("EARTHSHINE_CACHE", "none");
        EXPECT_EQ(cacheFolderFor(""), "");
    }
    const Environment own("EARTHSHINE_CACHE", nullptr);
    {
        const Environment xdg("XDG_CACHE_HOME", "/x");
        EXPECT_EQ(cacheFolderFor(""), "/x/earthshine");
    }
    const Environment xdg("XDG_CACHE_HOME", nullptr);
    EXPECT_EQ(cacheFolderFor(""), "/h/.cache/earthshine");
    const Environment noHome("HOME", nullptr);
    EXPECT_EQ(cacheFolderFor(""), "");
}

}  // namespace
}  // namespace earthshine
