#pragma once
// A small bitmap font, so that a label needs no font file on the machine.

#include <array>
#include <cstdint>

namespace earthshine {

inline constexpr int kGlyphWidthPx = 5;
inline constexpr int kGlyphHeightPx = 7;

/// Rows from the top; the leftmost pixel is bit 4.
using Glyph = std::array<std::uint8_t, kGlyphHeightPx>;

/// The glyph of a lower-case letter, a digit or one of " -+.,:/()%"; upper case is drawn as lower; blank for the rest.
const Glyph& glyph(char character);

}  // namespace earthshine
