#pragma once
// Several pictures side by side in one, each with its name above it.

#include <span>
#include <string>

#include "earthshine/image.hpp"

namespace earthshine {

/// One picture of a sheet.
struct Panel {
    std::string label;  ///< drawn in lower case; characters that the built-in font lacks become blanks
    ImageView image;    ///< RGBA8, sRGB-encoded
};

/// Panels in rows of `columns`, left to right and top to bottom, on dark grey; nothing is scaled. RGBA8; panels
/// keep their alpha, the rest is opaque.
/// Throws UsageError if there are none, if one is not RGBA8, or if their extents differ.
HostImage contactSheet(std::span<const Panel> panels, int columns);

/// What indirect light changes on the screen: gain x (both - direct), channel by channel of two RGBA8 pictures as they
/// are displayed (sRGB-encoded, one exposure), clipped to [0; 255]; opaque. Black: no change.
/// Throws UsageError if the formats are not RGBA8 or the extents differ.
HostImage displayDifference(const ImageView& both, const ImageView& direct, float gain);

}  // namespace earthshine
