// Contact sheets: panels where they belong, labels that can be read, a difference that means what it says.

#include "image/contact_sheet.hpp"

#include <cstring>
#include <set>
#include <vector>

#include <gmock/gmock.h>

#include "earthshine/error.hpp"
#include "image/font.hpp"
#include "temp_folder.hpp"

namespace earthshine {
namespace {

using test::thrown;
using ::testing::HasSubstr;

HostImage filled(Extent extent, unsigned char r, unsigned char g, unsigned char b) {
    HostImage image(PixelFormat::RGBA8, extent);
    auto* p = reinterpret_cast<unsigned char*>(image.data());
    for (int i = 0; i < extent.widthPx * extent.heightPx; ++i, p += 4) p[0] = r, p[1] = g, p[2] = b, p[3] = 255;
    return image;
}

const unsigned char* at(const HostImage& image, int x, int y) {
    return reinterpret_cast<const unsigned char*>(image.data()) + 4 * (y * image.extent().widthPx + x);
}

int countColor(const HostImage& image, unsigned char r, unsigned char g, unsigned char b) {
    int count = 0;
    for (int y = 0; y < image.extent().heightPx; ++y)
        for (int x = 0; x < image.extent().widthPx; ++x) {
            const unsigned char* p = at(image, x, y);
            count += p[0] == r && p[1] == g && p[2] == b && p[3] == 255;
        }
    return count;
}

TEST(ContactSheet, FourPanelsInTheirCorners) {
    const Extent extent{64, 36};
    const HostImage red = filled(extent, 255, 0, 0), green = filled(extent, 0, 255, 0),
                    blue = filled(extent, 0, 0, 255), black = filled(extent, 0, 0, 0);
    const std::vector<Panel> panels{
        {"direct", red.view()}, {"indirect", green.view()}, {"both", blue.view()}, {"", black.view()}};
    const HostImage sheet = contactSheet(panels, 2);
    // Gutters of 4 and labels of 11 pixels at this size.
    EXPECT_EQ(sheet.extent(), (Extent{2 * 64 + 3 * 4, 2 * (36 + 11) + 3 * 4}));
    EXPECT_EQ(countColor(sheet, 255, 0, 0), 64 * 36);
    EXPECT_EQ(countColor(sheet, 0, 255, 0), 64 * 36);
    EXPECT_EQ(countColor(sheet, 0, 0, 255), 64 * 36);
    EXPECT_EQ(countColor(sheet, 0, 0, 0), 64 * 36);
    EXPECT_EQ(at(sheet, 4, 15)[0], 255);                 // first row, left
    EXPECT_EQ(at(sheet, 64 + 8 + 63, 15 + 35)[1], 255);  // first row, right: its last pixel
    EXPECT_EQ(at(sheet, 4, 15 + 36 + 4 + 11)[2], 255);   // second row, left
}

TEST(ContactSheet, LabelsStandAboveTheirPanels) {
    const HostImage black = filled({64, 36}, 0, 0, 0);
    const std::vector<Panel> named{{"Il.", black.view()}}, plain{{"", black.view()}};
    const HostImage with = contactSheet(named, 1), without = contactSheet(plain, 1);
    int ink = 0;
    for (const char c : {'i', 'l', '.'})
        for (const auto row : glyph(c)) ink += __builtin_popcount(row);
    int different = 0;
    for (int y = 0; y < with.extent().heightPx; ++y)
        for (int x = 0; x < with.extent().widthPx; ++x)
            if (std::memcmp(at(with, x, y), at(without, x, y), 4) != 0) {
                ++different;
                EXPECT_LT(y, 15);
            }
    EXPECT_EQ(different, ink);
}

TEST(ContactSheet, LabelsThatAreTooLongAreCutAtTheirPanel) {
    const HostImage black = filled({16, 8}, 0, 0, 0);
    const std::vector<Panel> panels{{"abcdefghijklmnop", black.view()}};
    const HostImage sheet = contactSheet(panels, 1);
    for (int y = 0; y < sheet.extent().heightPx; ++y)
        for (int x = 4 + 16; x < sheet.extent().widthPx; ++x) EXPECT_EQ(at(sheet, x, y)[0], at(sheet, 0, 0)[0]);
}

TEST(ContactSheet, EveryGlyphIsItsOwn) {
    std::set<Glyph> glyphs;
    const std::string characters = "abcdefghijklmnopqrstuvwxyz0123456789 -+.,:/()%";
    for (const char c : characters) glyphs.insert(glyph(c));
    EXPECT_EQ(glyphs.size(), characters.size());
    EXPECT_EQ(glyph('Q'), glyph('q'));
    EXPECT_EQ(glyph('\xff'), glyph(' '));
}

TEST(ContactSheet, UnfitPanelsAreRefused) {
    const HostImage a = filled({4, 4}, 0, 0, 0), b = filled({5, 4}, 0, 0, 0), c(PixelFormat::RGBA32F, {4, 4});
    const auto make = [](std::vector<Panel> panels) { contactSheet(panels, 2); };
    EXPECT_THAT(thrown<UsageError>([&] { make({}); }), HasSubstr("needs a panel"));
    EXPECT_THAT(thrown<UsageError>([&] { make({{"a", a.view()}, {"b", b.view()}}); }), HasSubstr("4x4 and 5x4"));
    EXPECT_THAT(thrown<UsageError>([&] { make({{"c", c.view()}}); }), HasSubstr("RGBA8"));
}

TEST(DisplayDifference, IsWhatWasAddedTimesTheGain) {
    const HostImage both = filled({2, 1}, 100, 10, 255), direct = filled({2, 1}, 90, 20, 0);
    const HostImage difference = displayDifference(both.view(), direct.view(), 2.0f);
    EXPECT_EQ(at(difference, 1, 0)[0], 20);
    EXPECT_EQ(at(difference, 1, 0)[1], 0);
    EXPECT_EQ(at(difference, 1, 0)[2], 255);
    EXPECT_EQ(at(difference, 1, 0)[3], 255);
}

}  // namespace
}  // namespace earthshine
