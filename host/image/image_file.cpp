#include "image/image_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine {

namespace {

constexpr float kRec709Chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

bool isHalf(const ImageView& image) {
    return image.format == PixelFormat::RGBA16F;
}

std::size_t pixelCount(Extent extent) {
    return std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
}

/// OpenImageIO's words on one line, without the file's name, which every message of ours begins with.
std::string reason(std::string text, const std::filesystem::path& path) {
    for (const std::string& name : {fmt::format("\"{}\"", path.string()), path.string()})
        if (const auto at = text.find(name); at != std::string::npos) text.erase(at, name.size());
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text.empty() ? "no reason given" : text;
}

std::unique_ptr<OIIO::ImageInput> openPicture(const std::filesystem::path& path, const char* format,
                                              const char* formatForPeople, OIIO::ImageSpec& spec) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(fmt::format("{}: no such file", path.string()));
    auto input = OIIO::ImageInput::create(format);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    if (!input || !input->open(path.string(), spec, config))
        throw InputError(fmt::format("{}: cannot be read as {}: {}", path.string(), formatForPeople,
                                     reason(input ? input->geterror() : OIIO::geterror(), path)));
    if (spec.width < 1 || spec.height < 1 || spec.width > kMaxSidePx || spec.height > kMaxSidePx)
        throw InputError(fmt::format("{}: {}x{} pixels; expected 1 to {} a side", path.string(), spec.width,
                                     spec.height, kMaxSidePx));
    return input;
}

std::unique_ptr<OIIO::ImageInput> openExr(const std::filesystem::path& path, OIIO::ImageSpec& spec) {
    auto input = openPicture(path, "openexr", "OpenEXR", spec);
    if (spec.deep) throw InputError(fmt::format("{}: deep pictures are not supported; flatten it", path.string()));
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height)
        throw InputError(
            fmt::format("{}: its data window is not its display window; save it uncropped", path.string()));
    return input;
}

void writePicture(const std::filesystem::path& path, const char* format, const OIIO::ImageSpec& spec,
                  OIIO::TypeDesc type, const void* pixels, OIIO::stride_t pixelStride) {
    auto output = OIIO::ImageOutput::create(format);
    if (!output || !output->open(path.string(), spec) || !output->write_image(type, pixels, pixelStride) ||
        !output->close())
        throw Error(fmt::format("{}: cannot be written: {}", path.string(),
                                reason(output ? output->geterror() : OIIO::geterror(), path)));
}

void checkLayers(std::span<const Layer> layers) {
    if (layers.empty()) throw UsageError("writeExr: needs at least one layer");
    std::set<std::string> names;
    for (const Layer& layer : layers) {
        const Extent extent = layer.image.extent;
        if (layer.image.empty() || layer.image.format == PixelFormat::RGBA8)
            throw UsageError(
                fmt::format("writeExr: layer '{}' is empty or RGBA8; expected R32F, RGBA16F or RGBA32F", layer.name));
        if (extent != layers[0].image.extent)
            throw UsageError(fmt::format("writeExr: layer '{}' is {}x{}, the first is {}x{}", layer.name,
                                         extent.widthPx, extent.heightPx, layers[0].image.extent.widthPx,
                                         layers[0].image.extent.heightPx));
        if (layer.channels.empty() || layer.channels.size() > std::size_t(channelCount(layer.image.format)))
            throw UsageError(fmt::format("writeExr: layer '{}' names {} channels, its image has {}", layer.name,
                                         layer.channels.size(), channelCount(layer.image.format)));
        for (const std::string& channel : layer.channels)
            if (!names.insert(layer.name.empty() ? channel : layer.name + "." + channel).second)
                throw UsageError(fmt::format("writeExr: two channels are named '{}'", channel));
    }
}

}  // namespace

void writeExr(const std::filesystem::path& path, std::span<const Layer> layers, const Attributes& attributes) {
    checkLayers(layers);
    const Extent extent = layers[0].image.extent;
    OIIO::ImageSpec spec(extent.widthPx, extent.heightPx, 0, OIIO::TypeDesc::FLOAT);
    spec.channelnames.clear();
    std::size_t pixelBytes = 0;
    for (const Layer& layer : layers) {
        for (const std::string& channel : layer.channels) {
            spec.channelnames.push_back(layer.name.empty() ? channel : layer.name + "." + channel);
            spec.channelformats.push_back(isHalf(layer.image) ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
            pixelBytes += isHalf(layer.image) ? 2 : 4;
        }
    }
    spec.nchannels = int(spec.channelnames.size());
    spec.alpha_channel = spec.z_channel = -1;
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");  // else the clock's, and the same picture would never be the same file
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kRec709Chromaticities);
    for (const auto& [name, value] : attributes)
        std::visit([&, &key = name](const auto& v) { spec.attribute(key, v); }, value);

    // Each pixel's channels behind one another, each in its own type: what OpenImageIO calls native.
    std::vector<std::byte> pixels(pixelBytes * pixelCount(extent));
    std::size_t offset = 0;
    for (const Layer& layer : layers) {
        const std::size_t step = bytesPerPixel(layer.image.format);
        const std::size_t bytes = layer.channels.size() * (isHalf(layer.image) ? 2 : 4);
        const auto* from = static_cast<const std::byte*>(layer.image.data);
        for (std::size_t i = 0; i < pixelCount(extent); ++i)
            std::memcpy(&pixels[i * pixelBytes + offset], from + i * step, bytes);
        offset += bytes;
    }
    writePicture(path, "openexr", spec, OIIO::TypeDesc::UNKNOWN, pixels.data(), OIIO::AutoStride);
}

bool ExrHeader::has(const std::string& channel) const {
    return std::find(channels.begin(), channels.end(), channel) != channels.end();
}

ExrHeader readExrHeader(const std::filesystem::path& path) {
    OIIO::ImageSpec spec;
    openExr(path, spec);
    return {{spec.width, spec.height}, spec.channelnames};
}

HostImage readExr(const std::filesystem::path& path, std::span<const std::string> channels, PixelFormat format) {
    if (channels.empty() || channels.size() > std::size_t(channelCount(format)) || format == PixelFormat::RGBA8)
        throw UsageError(fmt::format("readExr: {} channels do not go into {}", channels.size(), formatName(format)));
    OIIO::ImageSpec spec;
    const auto input = openExr(path, spec);
    std::vector<int> places;
    for (const std::string& channel : channels) {
        const int place = spec.channelindex(channel);
        if (place < 0)
            throw InputError(fmt::format("{}: no channel '{}'; it has {}", path.string(), channel,
                                         fmt::join(spec.channelnames, ", ")));
        const OIIO::TypeDesc type = spec.channelformat(place);
        if (type != OIIO::TypeDesc::HALF && type != OIIO::TypeDesc::FLOAT)
            throw InputError(
                fmt::format("{}: channel '{}' holds integers; expected half or float", path.string(), channel));
        places.push_back(place);
    }

    // One pass over the span of channels that holds them all: a read decompresses every channel anyway.
    const auto [first, last] = std::minmax_element(places.begin(), places.end());
    const int begin = *first, end = *last + 1;
    const Extent extent{spec.width, spec.height};
    std::vector<float> span(pixelCount(extent) * std::size_t(end - begin));
    if (!input->read_image(0, 0, begin, end, OIIO::TypeDesc::FLOAT, span.data()))
        throw InputError(fmt::format("{}: cannot be read: {}", path.string(), reason(input->geterror(), path)));

    HostImage result(format, extent);
    const auto stride = std::size_t(end - begin), width = std::size_t(channelCount(format));
    for (std::size_t c = 0; c < places.size(); ++c) {
        const float* in = span.data() + (places[c] - begin);
        if (format == PixelFormat::RGBA16F) {
            auto* out = reinterpret_cast<std::uint16_t*>(result.data()) + c;
            for (std::size_t i = 0; i < pixelCount(extent); ++i) out[i * width] = halfFromFloat(in[i * stride]);
        } else {
            float* out = result.pixel(0, 0) + c;
            for (std::size_t i = 0; i < pixelCount(extent); ++i) out[i * width] = in[i * stride];
        }
    }
    return result;
}

void writePng(const std::filesystem::path& path, const ImageView& image) {
    if (image.empty() || image.format != PixelFormat::RGBA8)
        throw UsageError(fmt::format("writePng: {} given; expected RGBA8", formatName(image.format)));
    const auto* bytes = static_cast<const unsigned char*>(image.data);
    bool opaque = true;
    for (std::size_t i = 0; i < pixelCount(image.extent); ++i) opaque = opaque && bytes[4 * i + 3] == 255;
    OIIO::ImageSpec spec(image.extent.widthPx, image.extent.heightPx, opaque ? 3 : 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", "sRGB");
    writePicture(path, "png", spec, OIIO::TypeDesc::UINT8, image.data, 4);
}

HostImage readPng(const std::filesystem::path& path) {
    OIIO::ImageSpec spec;
    const auto input = openPicture(path, "png", "PNG", spec);
    const auto channels = std::size_t(spec.nchannels);
    HostImage result(PixelFormat::RGBA8, {spec.width, spec.height});
    std::vector<unsigned char> pixels(pixelCount(result.extent()) * channels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, pixels.data()))
        throw InputError(fmt::format("{}: cannot be read: {}", path.string(), reason(input->geterror(), path)));
    auto* out = reinterpret_cast<unsigned char*>(result.data());
    for (std::size_t i = 0; i < pixelCount(result.extent()); ++i) {
        const unsigned char* in = &pixels[i * channels];
        const bool grey = channels < 3;
        for (std::size_t c = 0; c < 3; ++c) out[4 * i + c] = in[grey ? 0 : c];
        out[4 * i + 3] = channels % 2 == 0 ? in[channels - 1] : 255;
    }
    return result;
}

NonFinite findNonFinite(const ImageView& image) {
    NonFinite result;
    if (image.empty() || image.format == PixelFormat::RGBA8) return result;
    const auto channels = std::size_t(channelCount(image.format));
    for (std::size_t i = 0; i < pixelCount(image.extent) * channels; ++i) {
        // Looked at as bits: an optimizer that assumes finite mathematics may not remove this.
        const bool finite = isHalf(image)
                                ? (static_cast<const std::uint16_t*>(image.data)[i] & 0x7c00u) != 0x7c00u
                                : (static_cast<const std::uint32_t*>(image.data)[i] & 0x7f800000u) != 0x7f800000u;
        if (finite || result.count++ > 0) continue;
        result.xPx = int(i / channels % std::size_t(image.extent.widthPx));
        result.yPx = int(i / channels / std::size_t(image.extent.widthPx));
    }
    return result;
}

void setImageThreads(int count) {
    OIIO::attribute("threads", count);
    OIIO::attribute("exr_threads", count);
}

}  // namespace earthshine
