#pragma once
// Pictures in files: OpenEXR for numbers, PNG for screens. Channels are found by name, never by place, because EXR
// sorts them; nothing is converted between colour spaces, so what goes in is what comes out, bit for bit.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "earthshine/image.hpp"

namespace earthshine {

/// The longest side of a picture that is read; longer ones are taken for broken headers.
inline constexpr int kMaxSidePx = 16384;

/// One picture of an EXR file. RGBA16F is stored as HALF, R32F and RGBA32F as FLOAT: exactly.
struct Layer {
    std::string name;                   ///< before the channels' names and a dot; "" for the main picture
    ImageView image;                    ///< R32F, RGBA16F or RGBA32F
    std::vector<std::string> channels;  ///< names of the image's first channels; those beyond are not stored
};

/// Words and numbers in an EXR's header.
using Attributes = std::vector<std::pair<std::string, std::variant<std::string, float>>>;

/// Writes layers of one extent into one scanline EXR (ZIP; Rec. 709 chromaticities). Values that are not finite are
/// stored as they are: look for them first (findNonFinite). Whatever the file's extension, it becomes an EXR.
/// Throws UsageError for layers that do not fit together, Error if the file cannot be written.
void writeExr(const std::filesystem::path& path, std::span<const Layer> layers, const Attributes& attributes = {});

/// What an EXR holds, without its pixels.
struct ExrHeader {
    Extent extent;
    std::vector<std::string> channels;  ///< "R", "indirect.G", ...; in no order to rely on
    bool has(const std::string& channel) const;
};

/// Throws InputError if the file is missing, is no EXR, is deep, cropped, or larger than kMaxSidePx.
ExrHeader readExrHeader(const std::filesystem::path& path);

/// The named channels as the first channels of an image of `format` (R32F, RGBA16F or RGBA32F); the others are 0.
/// HALF and FLOAT channels convert to each other, to the nearest even.
/// Throws InputError if the file cannot be read or a channel is not there or holds integers.
HostImage readExr(const std::filesystem::path& path, std::span<const std::string> channels, PixelFormat format);

/// Writes RGBA8 as an 8-bit sRGB PNG with unassociated alpha; without an alpha channel if every alpha is 255.
/// Throws UsageError for another format, Error if the file cannot be written.
void writePng(const std::filesystem::path& path, const ImageView& image);

/// Any PNG as RGBA8, alpha unassociated (255 if the file has none). Throws InputError if it cannot be read.
HostImage readPng(const std::filesystem::path& path);

/// How many channel values are infinite or not a number, and the first pixel that has one.
struct NonFinite {
    std::size_t count = 0;
    int xPx = 0, yPx = 0;
};
NonFinite findNonFinite(const ImageView& image);

/// How many threads reading and writing of pictures may use; 0 = one a core (the default).
void setImageThreads(int count);

}  // namespace earthshine
