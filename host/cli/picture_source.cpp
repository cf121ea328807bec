#include "cli/picture_source.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "earthshine/error.hpp"
#include "image/image_file.hpp"

namespace earthshine::cli {

namespace {

std::string layerOf(const std::string& channel) {
    const auto dot = channel.rfind('.');
    return dot == std::string::npos ? "color" : channel.substr(0, dot);
}

std::vector<std::string> channelsOf(const std::filesystem::path& path, const ExrHeader& header,
                                    const std::string& layer) {
    const std::string prefix = layer.empty() || layer == "color" ? "" : layer + ".";
    for (const auto& names : {std::vector<std::string>{"R", "G", "B"}, {"X", "Y", "Z"}, {"Z"}, {"Y"}}) {
        std::vector<std::string> full;
        for (const std::string& name : names) full.push_back(prefix + name);
        if (std::all_of(full.begin(), full.end(), [&](const auto& name) { return header.has(name); })) return full;
    }
    std::set<std::string> layers;
    for (const std::string& channel : header.channels) layers.insert(layerOf(channel));
    throw InputError(fmt::format("{}: has no layer '{}'; it has {}", path.string(), layer.empty() ? "color" : layer,
                                 fmt::join(layers, ", ")));
}

LoadedPicture loadPng(const std::filesystem::path& path) {
    LoadedPicture picture{path.string(), PictureKind::Display, {"R", "G", "B"}, toFloat(readPng(path).view()), {}};
    const auto [width, height] = picture.pixels.extent();
    for (std::size_t i = 0; i < 4 * std::size_t(width) * std::size_t(height); ++i)
        picture.pixels.pixel(0, 0)[i] = linearFromSrgb(picture.pixels.pixel(0, 0)[i]);
    return picture;
}

}  // namespace

LoadedPicture loadPicture(const std::filesystem::path& path, const std::string& layer,
                          const std::vector<std::string>& channels) {
    if (path.extension() == ".png") {
        if (!layer.empty() || !channels.empty())
            throw InputError(fmt::format("{}: a PNG has no layers to choose from", path.string()));
        return loadPng(path);
    }
    const ExrHeader header = readExrHeader(path);
    LoadedPicture picture;
    picture.name = layer.empty() ? path.string() : fmt::format("{} ({})", path.string(), layer);
    picture.channels = channels.empty() ? channelsOf(path, header, layer) : channels;
    picture.pixels = readExr(path, picture.channels, PixelFormat::RGBA32F);
    if (picture.channels.size() == 1)
        for (int y = 0; y < header.extent.heightPx; ++y)
            for (int x = 0; x < header.extent.widthPx; ++x) {
                float* p = picture.pixels.pixel(x, y);
                p[1] = p[2] = p[0];
            }
    const std::vector<std::string> depth{"depth.Z"};
    if (header.has(depth[0])) picture.skyMask = readExr(path, depth, PixelFormat::R32F);
    return picture;
}

}  // namespace earthshine::cli
