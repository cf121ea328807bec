// Pictures in files: what goes in comes out, bit for bit, and broken files end in one line.

#include "image/image_file.hpp"

#include <cstring>
#include <limits>

#include <gmock/gmock.h>

#include "earthshine/error.hpp"
#include "temp_folder.hpp"

namespace earthshine {
namespace {

using test::TempFolder;
using test::thrown;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

std::uint16_t* halves(HostImage& image) {
    return reinterpret_cast<std::uint16_t*>(image.data());
}

bool sameBytes(const HostImage& a, const HostImage& b) {
    return a.format() == b.format() && a.extent() == b.extent() && std::memcmp(a.data(), b.data(), a.sizeBytes()) == 0;
}

class ImageFile : public ::testing::Test {
protected:
    void SetUp() override { setImageThreads(1); }
    TempFolder folder;
};

TEST_F(ImageFile, EveryHalfThatIsANumberSurvives) {
    HostImage image(PixelFormat::RGBA16F, {128, 128});
    for (unsigned i = 0; i < 65536; ++i) halves(image)[i] = std::uint16_t((i & 0x7c00u) == 0x7c00u ? 0u : i);
    const Layer layer{"", image.view(), {"R", "G", "B", "A"}};
    writeExr(folder / "a.exr", {&layer, 1});
    const std::vector<std::string> channels{"R", "G", "B", "A"};
    EXPECT_TRUE(sameBytes(image, readExr(folder / "a.exr", channels, PixelFormat::RGBA16F)));
}

TEST_F(ImageFile, LayersOfDifferentTypesAreFoundByName) {
    const Extent extent{7, 3};
    HostImage color(PixelFormat::RGBA32F, extent), indirect(PixelFormat::RGBA16F, extent),
        depth(PixelFormat::R32F, extent);
    for (int i = 0; i < 7 * 3 * 4; ++i) {
        color.pixel(0, 0)[i] = 1e-30f + float(i) / 3.0f;
        halves(indirect)[i] = halfFromFloat(float(i) * 0.37f);
    }
    for (int i = 0; i < 7 * 3; ++i) depth.pixel(0, 0)[i] = std::numeric_limits<float>::max() / float(i + 1);
    // Names chosen so that EXR's own order (sorted) is none of ours.
    const std::vector<Layer> layers{{"", color.view(), {"R", "G", "B", "A"}},
                                    {"zz", indirect.view(), {"R", "G", "B", "A"}},
                                    {"aa", depth.view(), {"Z"}}};
    writeExr(folder / "a.exr", layers, {{"note", "seven by three"}, {"exposure", 0.25f}});

    const ExrHeader header = readExrHeader(folder / "a.exr");
    EXPECT_EQ(header.extent, extent);
    EXPECT_THAT(header.channels, UnorderedElementsAre("R", "G", "B", "A", "zz.R", "zz.G", "zz.B", "zz.A", "aa.Z"));
    const std::vector<std::string> rgba{"R", "G", "B", "A"}, zz{"zz.R", "zz.G", "zz.B", "zz.A"}, z{"aa.Z"};
    EXPECT_TRUE(sameBytes(color, readExr(folder / "a.exr", rgba, PixelFormat::RGBA32F)));
    EXPECT_TRUE(sameBytes(indirect, readExr(folder / "a.exr", zz, PixelFormat::RGBA16F)));
    EXPECT_TRUE(sameBytes(depth, readExr(folder / "a.exr", z, PixelFormat::R32F)));

    const std::vector<std::string> mixed{"B", "aa.Z"};
    const HostImage two = readExr(folder / "a.exr", mixed, PixelFormat::RGBA32F);
    EXPECT_EQ(two.pixel(6, 2)[0], color.pixel(6, 2)[2]);
    EXPECT_EQ(two.pixel(6, 2)[1], depth.pixel(6, 2)[0]);
    EXPECT_EQ(two.pixel(6, 2)[2], 0.0f);
}

TEST_F(ImageFile, ChannelsThatAreNotNamedAreNotStored) {
    HostImage image(PixelFormat::RGBA32F, {2, 2});
    const Layer layer{"x", image.view(), {"R", "G", "B"}};
    writeExr(folder / "a.exr", {&layer, 1});
    EXPECT_THAT(readExrHeader(folder / "a.exr").channels, UnorderedElementsAre("x.R", "x.G", "x.B"));
}

TEST_F(ImageFile, PngKeepsColourUnderAlpha) {
    HostImage image(PixelFormat::RGBA8, {2, 1});
    const unsigned char pixels[8] = {200, 100, 50, 128, 255, 0, 7, 0};
    std::memcpy(image.data(), pixels, sizeof pixels);
    writePng(folder / "a.png", image.view());
    EXPECT_TRUE(sameBytes(image, readPng(folder / "a.png")));
}

TEST_F(ImageFile, OpaquePngReadsBackOpaque) {
    HostImage image(PixelFormat::RGBA8, {1, 2});
    const unsigned char pixels[8] = {1, 2, 3, 255, 254, 253, 252, 255};
    std::memcpy(image.data(), pixels, sizeof pixels);
    writePng(folder / "a.png", image.view());
    EXPECT_TRUE(sameBytes(image, readPng(folder / "a.png")));
}

TEST_F(ImageFile, NonFiniteValuesAreCountedAndPlaced) {
    HostImage image(PixelFormat::RGBA32F, {3, 2});
    EXPECT_EQ(findNonFinite(image.view()).count, 0u);
    image.pixel(2, 1)[3] = std::numeric_limits<float>::quiet_NaN();
    image.pixel(1, 1)[0] = -std::numeric_limits<float>::infinity();
    const NonFinite found = findNonFinite(image.view());
    EXPECT_EQ(found.count, 2u);
    EXPECT_EQ(found.xPx, 1);
    EXPECT_EQ(found.yPx, 1);

    HostImage half(PixelFormat::RGBA16F, {3, 2});
    halves(half)[4 * 2] = 0x7c00;
    halves(half)[4 * 2 + 1] = 0x7bff;  // the largest number
    EXPECT_EQ(findNonFinite(half.view()).count, 1u);
    EXPECT_EQ(findNonFinite(half.view()).xPx, 2);
}

TEST_F(ImageFile, BrokenFilesEndInOneLine) {
    const std::vector<std::string> red{"R"};
    const auto read = [&](const char* name) { readExr(folder / name, red, PixelFormat::R32F); };
    EXPECT_THAT(thrown<InputError>([&] { read("missing.exr"); }), HasSubstr("missing.exr: no such file"));
    EXPECT_THAT(thrown<InputError>([&] { readPng(folder / "missing.png"); }), HasSubstr("missing.png: no such file"));

    test::writeText(folder / "text.exr", "not a picture");
    EXPECT_THAT(thrown<InputError>([&] { read("text.exr"); }), HasSubstr("text.exr: cannot be read as OpenEXR"));
    EXPECT_THAT(thrown<InputError>([&] { readPng(folder / "text.exr"); }), HasSubstr("cannot be read as PNG"));

    HostImage image(PixelFormat::R32F, {64, 64});
    for (int i = 0; i < 64 * 64; ++i) image.pixel(0, 0)[i] = float(i * 7919 % 1000);
    const Layer layer{"", image.view(), {"Z"}};
    writeExr(folder / "z.exr", {&layer, 1});
    EXPECT_THAT(thrown<InputError>([&] { read("z.exr"); }), HasSubstr("no channel 'R'; it has Z"));

    const std::string whole = test::readText(folder / "z.exr");
    test::writeText(folder / "cut.exr", whole.substr(0, whole.size() / 2));
    const std::vector<std::string> z{"Z"};
    EXPECT_THAT(thrown<InputError>([&] { readExr(folder / "cut.exr", z, PixelFormat::R32F); }),
                HasSubstr("cut.exr: cannot be read"));
}

TEST_F(ImageFile, UnfitLayersAndPlacesAreRefused) {
    HostImage a(PixelFormat::RGBA32F, {2, 2}), b(PixelFormat::RGBA32F, {3, 2}), c(PixelFormat::RGBA8, {2, 2});
    const auto write = [&](std::vector<Layer> layers, const char* name = "a.exr") { writeExr(folder / name, layers); };
    EXPECT_THAT(thrown<UsageError>([&] { write({}); }), HasSubstr("at least one layer"));
    EXPECT_THAT(thrown<UsageError>([&] { write({{"", a.view(), {"R"}}, {"b", b.view(), {"R"}}}); }), HasSubstr("3x2"));
    EXPECT_THAT(thrown<UsageError>([&] { write({{"", a.view(), {"R"}}, {"", a.view(), {"R"}}}); }), HasSubstr("'R'"));
    EXPECT_THAT(thrown<UsageError>([&] { write({{"", c.view(), {"R"}}}); }), HasSubstr("RGBA8"));
    EXPECT_THAT(thrown<UsageError>([&] { writePng(folder / "a.png", a.view()); }), HasSubstr("RGBA8"));
    EXPECT_THAT(thrown<Error>([&] {
                    write({{"", a.view(), {"R"}}}, "no/such/a.exr");
                }),
                HasSubstr("a.exr: cannot be written"));
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace earthshine
