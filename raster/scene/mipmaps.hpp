#pragma once
// The smaller levels of a texture, made once for all: drivers differ, and some round every level down, which darkens
// colours by some percent and tilts normals by a degree (seen: Mesa 22.3's software rasterizers).

#include <cstdint>
#include <vector>

#include "raster/scene/scene.hpp"

namespace earthshine::raster {

/// One level, RGBA, as Texture keeps its texels: in 8 or 16 bits, sRGB-encoded or not.
struct MipLevel {
    int widthPx = 0;
    int heightPx = 0;
    std::vector<std::uint8_t> rgba8;  ///< empty if rgba16 holds the texels
    std::vector<std::uint16_t> rgba16;
};

/// Levels 1 and up, down to 1 x 1; each side is half of the one before, rounded down. A texel is what a linear filter
/// reads at its centre in the level before (the mean of four where sides are even), in linear light, to the nearest.
std::vector<MipLevel> smallerLevels(const Texture& texture);

}  // namespace earthshine::raster
