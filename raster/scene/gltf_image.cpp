#include "raster/scene/gltf_image.hpp"

#include <cstring>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace earthshine::raster {

namespace {

struct PictureInfo {
    std::uint64_t widthPx = 0;
    std::uint64_t heightPx = 0;
    int bits = 8;
};

std::uint64_t bigEndian(std::span<const unsigned char> bytes, std::size_t offset, std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[offset + i];
    return value;
}

std::optional<PictureInfo> pngInfo(std::span<const unsigned char> bytes) {
    constexpr unsigned char kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    constexpr std::size_t kWidthAt = 16, kDepthAt = 24;
    if (bytes.size() <= kDepthAt || std::memcmp(bytes.data(), kSignature, sizeof kSignature) != 0) return {};
    return PictureInfo{bigEndian(bytes, kWidthAt, 4), bigEndian(bytes, kWidthAt + 4, 4), bytes[kDepthAt]};
}

/// The frame header (SOF) of a JPEG stands after segments that tell their length. ITU T.81, B.1.1.
std::optional<PictureInfo> jpegInfo(std::span<const unsigned char> bytes) {
    if (bytes.size() < 4 || bytes[0] != 0xff || bytes[1] != 0xd8) return {};
    std::size_t offset = 2;
    while (offset + 9 <= bytes.size()) {
        const unsigned marker = bytes[offset + 1];
        if (bytes[offset] != 0xff || marker == 0xff) {  // padding
            ++offset;
            continue;
        }
        const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (frame) return PictureInfo{bigEndian(bytes, offset + 7, 2), bigEndian(bytes, offset + 5, 2), 8};
        offset += 2 + bigEndian(bytes, offset + 2, 2);
    }
    return {};
}

const char* formatOf(std::span<const unsigned char> bytes) {
    const auto startsWith = [&](const char* text, std::size_t at) {
        return bytes.size() >= at + std::strlen(text) && std::memcmp(bytes.data() + at, text, std::strlen(text)) == 0;
    };
    return startsWith("KTX 20", 1)                                 ? "is a KTX2 texture"
           : startsWith("WEBP", 8)                                 ? "is a WebP picture"
           : startsWith("DDS ", 0)                                 ? "is a DDS texture"
           : startsWith("GIF8", 0)                                 ? "is a GIF picture"
           : startsWith("BM", 0)                                   ? "is a BMP picture"
           : startsWith("\x89PNG", 0) || startsWith("\xff\xd8", 0) ? "is broken near its start"
                                                                   : "is of an unknown format";
}

/// The encoded picture: from its URI or, borrowed, from its buffer view.
class EncodedImage {
public:
    EncodedImage(const GltfContext& context, const tinygltf::Image& image, const std::string& place) {
        if (image.bufferView >= 0) {
            const tinygltf::BufferView& view = context.model.bufferViews[std::size_t(image.bufferView)];
            bytes_ = std::span(context.model.buffers[std::size_t(view.buffer)].data)
                         .subspan(view.byteOffset, view.byteLength);
        } else {
            owned_ = context.file.read(image.uri, place);
            bytes_ = owned_;
        }
    }
    EncodedImage(const EncodedImage&) = delete;
    EncodedImage& operator=(const EncodedImage&) = delete;
    std::span<const unsigned char> bytes() const noexcept { return bytes_; }

private:
    Bytes owned_;
    std::span<const unsigned char> bytes_;
};

}  // namespace

Texture decodeImage(const GltfContext& context, int image) {
    const tinygltf::Image& of = context.model.images[std::size_t(image)];
    std::string place = fmt::format("images[{}]", image);
    const EncodedImage encoded(context, of, place);
    const bool isFile = !of.uri.empty() && !of.uri.starts_with("data:");
    if (isFile || !of.name.empty()) place += fmt::format(": \"{}\"", printable(isFile ? of.uri : of.name));

    const std::span<const unsigned char> bytes = encoded.bytes();
    const std::optional<PictureInfo> png = pngInfo(bytes);
    const std::optional<PictureInfo> info = png ? png : jpegInfo(bytes);
    if (!info) context.file.fail(place, fmt::format("{}; PNG and JPEG are read", formatOf(bytes)));
    constexpr auto kMost = std::uint64_t(gltf_limits::kImageSidePx);
    const bool sizeIsSane =
        info->widthPx >= 1 && info->heightPx >= 1 && info->widthPx <= kMost && info->heightPx <= kMost;
    if (!sizeIsSane ||
        info->widthPx * info->heightPx * 4 * std::uint64_t(info->bits > 8 ? 2 : 1) > gltf_limits::kImageBytes) {
        context.file.fail(place, fmt::format("is {} x {} pixels; 1 to {} a side and {} B are read", info->widthPx,
                                             info->heightPx, kMost, gltf_limits::kImageBytes));
    }
    tinygltf::Image decoded;
    std::string error;
    std::string warning;
    if (!tinygltf::LoadImageData(&decoded, image, &error, &warning, 0, 0, bytes.data(), int(bytes.size()), nullptr)) {
        context.file.fail(place, "cannot be decoded; the picture is broken");
    }
    Texture texture;
    texture.name = !of.name.empty() ? of.name : isFile ? of.uri : fmt::format("image {}", image);
    texture.widthPx = decoded.width;
    texture.heightPx = decoded.height;
    if (decoded.bits == 16) {
        texture.rgba16.resize(decoded.image.size() / 2);
        std::memcpy(texture.rgba16.data(), decoded.image.data(), decoded.image.size());
    } else {
        texture.rgba8 = std::move(decoded.image);
    }
    return texture;
}

}  // namespace earthshine::raster
