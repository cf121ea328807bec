#include "image/contact_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "earthshine/error.hpp"
#include "image/font.hpp"

namespace earthshine {

namespace {

constexpr unsigned char kPaper = 32;  // sRGB grey levels: text and pictures stand out from it, bright or dark
constexpr unsigned char kInk = 224;

unsigned char* pixel8(HostImage& image, int x, int y) {
    return reinterpret_cast<unsigned char*>(image.data()) +
           4 * (std::size_t(y) * std::size_t(image.extent().widthPx) + std::size_t(x));
}

/// Draws what fits into `widthPx` pixels from (x, y) on.
void drawText(HostImage& image, const std::string& text, int x, int y, int widthPx, int scale) {
    const int advance = (kGlyphWidthPx + 1) * scale;
    for (std::size_t i = 0; i < text.size() && int(i) * advance + kGlyphWidthPx * scale <= widthPx; ++i) {
        const Glyph& rows = glyph(text[i]);
        for (int py = 0; py < kGlyphHeightPx * scale; ++py)
            for (int px = 0; px < kGlyphWidthPx * scale; ++px)
                if (rows[std::size_t(py / scale)] >> (kGlyphWidthPx - 1 - px / scale) & 1)
                    std::memset(pixel8(image, x + int(i) * advance + px, y + py), kInk, 3);
    }
}

void checkRgba8(const ImageView& image, Extent extent, const char* who) {
    if (image.empty() || image.format != PixelFormat::RGBA8)
        throw UsageError(fmt::format("{}: a picture is empty or not RGBA8", who));
    if (image.extent != extent)
        throw UsageError(fmt::format("{}: pictures of {}x{} and {}x{}; they must be of one size", who, extent.widthPx,
                                     extent.heightPx, image.extent.widthPx, image.extent.heightPx));
}

}  // namespace

HostImage contactSheet(std::span<const Panel> panels, int columns) {
    if (panels.empty() || columns < 1) throw UsageError("contactSheet: needs a panel and a column");
    const Extent extent = panels[0].image.extent;
    for (const Panel& panel : panels) checkRgba8(panel.image, extent, "contactSheet");

    const int scale = std::clamp(extent.widthPx / 320, 1, 8);  // text of about a fortieth of the panel's height
    const int gutter = 4 * scale, labelHeight = (kGlyphHeightPx + 4) * scale;
    const int rows = (int(panels.size()) + columns - 1) / columns;
    HostImage sheet(PixelFormat::RGBA8, {columns * (extent.widthPx + gutter) + gutter,
                                         rows * (extent.heightPx + labelHeight + gutter) + gutter});
    for (int y = 0; y < sheet.extent().heightPx; ++y)
        for (int x = 0; x < sheet.extent().widthPx; ++x) {
            std::memset(pixel8(sheet, x, y), kPaper, 3);
            pixel8(sheet, x, y)[3] = 255;
        }
    for (int i = 0; i < int(panels.size()); ++i) {
        const int left = gutter + i % columns * (extent.widthPx + gutter);
        const int top = gutter + i / columns * (extent.heightPx + labelHeight + gutter);
        drawText(sheet, panels[std::size_t(i)].label, left, top + scale, extent.widthPx, scale);
        const auto* from = static_cast<const unsigned char*>(panels[std::size_t(i)].image.data);
        const std::size_t rowBytes = 4 * std::size_t(extent.widthPx);
        for (int y = 0; y < extent.heightPx; ++y)
            std::memcpy(pixel8(sheet, left, top + labelHeight + y), from + std::size_t(y) * rowBytes, rowBytes);
    }
    return sheet;
}

HostImage displayDifference(const ImageView& both, const ImageView& direct, float gain) {
    checkRgba8(both, both.extent, "displayDifference");
    checkRgba8(direct, both.extent, "displayDifference");
    HostImage result(PixelFormat::RGBA8, both.extent);
    const auto* a = static_cast<const unsigned char*>(both.data);
    const auto* b = static_cast<const unsigned char*>(direct.data);
    auto* out = reinterpret_cast<unsigned char*>(result.data());
    for (std::size_t i = 0; i < both.sizeBytes(); ++i) {
        const float difference = gain * float(int(a[i]) - int(b[i]));
        out[i] = i % 4 == 3 ? 255 : static_cast<unsigned char>(std::clamp(std::round(difference), 0.0f, 255.0f));
    }
    return result;
}

}  // namespace earthshine
