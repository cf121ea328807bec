#include "image/inputs_folder.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "earthshine/error.hpp"
#include "image/image_file.hpp"
#include "image/inputs_json.hpp"
#include "image/output_set.hpp"

namespace fs = std::filesystem;

namespace earthshine {

namespace {

/// What the pixels of an image mean, as far as reading and checking goes.
enum class Kind { Color, Normal, Depth, Motion };

struct ImageSpec {
    const char* key;
    Kind kind;
    PixelFormat format;
};

constexpr ImageSpec kAlbedo{"albedo", Kind::Color, PixelFormat::RGBA16F};
constexpr ImageSpec kNormal{"normal", Kind::Normal, PixelFormat::RGBA16F};
constexpr ImageSpec kDepth{"depth", Kind::Depth, PixelFormat::R32F};
constexpr ImageSpec kMotion{"motion", Kind::Motion, PixelFormat::RGBA16F};
constexpr ImageSpec kEmission{"emission", Kind::Color, PixelFormat::RGBA16F};
constexpr ImageSpec kRsmDepth{"rsmDepth", Kind::Depth, PixelFormat::R32F};
constexpr ImageSpec kRsmNormal{"rsmNormal", Kind::Normal, PixelFormat::RGBA16F};
constexpr ImageSpec kRsmFlux{"rsmFlux", Kind::Color, PixelFormat::RGBA32F};
constexpr ImageSpec kShadowDepth{"shadowDepth", Kind::Depth, PixelFormat::R32F};

std::vector<std::string> channelNames(Kind kind) {
    switch (kind) {
        case Kind::Color:
            return {"R", "G", "B", "A"};
        case Kind::Normal:
            return {"X", "Y", "Z", "valid"};
        case Kind::Motion:
            return {"X", "Y", "Z", "W"};
        case Kind::Depth:
            return {"Z"};
    }
    return {};
}

/// The file's channels that stand for ours, in our order; the fourth only if it is there.
std::vector<std::string> matchChannels(const ExrHeader& header, Kind kind, const fs::path& path) {
    if (kind == Kind::Depth) {
        for (const char* name : {"Z", "depth", "R", "Y"})
            if (header.has(name)) return {name};
        if (header.channels.size() == 1) return header.channels;
    } else {
        for (std::vector<std::string> names : {std::vector<std::string>{"X", "Y", "Z"}, {"R", "G", "B"}}) {
            if (!header.has(names[0]) || !header.has(names[1]) || !header.has(names[2])) continue;
            for (const char* fourth : {"valid", "A", "W"}) {
                if (!header.has(fourth)) continue;
                names.emplace_back(fourth);
                break;
            }
            return names;
        }
    }
    throw InputError(fmt::format("{}: expected channels {}; it has {}", path.string(),
                                 fmt::join(channelNames(kind), " "), fmt::join(header.channels, " ")));
}

float* floats(HostImage& image) {
    return image.pixel(0, 0);
}

std::size_t pixelCount(Extent extent) {
    return std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
}

void checkFinite(const ImageView& image, const fs::path& path) {
    const NonFinite found = findNonFinite(image);
    if (found.count > 0)
        throw InputError(fmt::format("{}: {} values are not finite (or too large for {}), the first at pixel ({}, {})",
                                     path.string(), found.count, formatName(image.format), found.xPx, found.yPx));
}

void checkDepth(const HostImage& depth, const fs::path& path) {
    const auto width = std::size_t(depth.extent().widthPx);
    for (std::size_t i = 0; i < pixelCount(depth.extent()); ++i)
        if (depth.pixel(0, 0)[i] < 0.0f)
            throw InputError(fmt::format("{}: depth {} at pixel ({}, {}); expected metres along -z, > 0, or 0 for none",
                                         path.string(), depth.pixel(0, 0)[i], i % width, i / width));
}

/// Normals packed into [0; 1], left in object space under a scale, or filtered are the usual mistakes.
void checkNormals(const HostImage& normals, const fs::path& path) {
    const HostImage values = toFloat(normals.view());
    std::size_t valid = 0, wrong = 0;
    for (std::size_t i = 0; i < pixelCount(values.extent()); ++i) {
        const float* n = values.pixel(0, 0) + 4 * i;
        if (n[3] <= 0.0f) continue;
        ++valid;
        // 5 %: eight bits a channel pass. One pixel in a hundred may be a seam or a degenerate triangle.
        if (std::fabs(std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) - 1.0f) > 0.05f) ++wrong;
    }
    if (wrong * 100 > valid)
        throw InputError(fmt::format("{}: {} of {} normals are not of length 1; expected world space, each in [-1; 1]",
                                     path.string(), wrong, valid));
}

HostImage readImage(const fs::path& path, const ImageSpec& spec, const HostImage* depth) {
    const ExrHeader header = readExrHeader(path);
    const std::vector<std::string> channels = matchChannels(header, spec.kind, path);
    HostImage image = readExr(path, channels, spec.format);
    checkFinite(image.view(), path);
    if (depth && depth->extent() != image.extent())
        throw InputError(fmt::format("{}: {}x{} pixels, but the depth beside it has {}x{}", path.string(),
                                     image.extent().widthPx, image.extent().heightPx, depth->extent().widthPx,
                                     depth->extent().heightPx));
    if (channels.size() == 3 && spec.kind != Kind::Motion) {
        for (std::size_t i = 0; i < pixelCount(image.extent()); ++i) {
            const bool set = spec.kind == Kind::Color || depth->pixel(0, 0)[i] > 0.0f;
            if (spec.format == PixelFormat::RGBA32F)
                floats(image)[4 * i + 3] = set ? 1.0f : 0.0f;
            else
                reinterpret_cast<std::uint16_t*>(image.data())[4 * i + 3] = halfFromFloat(set ? 1.0f : 0.0f);
        }
    }
    if (spec.kind == Kind::Depth) checkDepth(image, path);
    if (spec.kind == Kind::Normal) checkNormals(image, path);
    return image;
}

/// The maps of all lights below one another, as FrameImages wants them. `image` belongs to light `index`.
void stack(HostImage& all, const HostImage& image, std::size_t index, std::size_t count, const fs::path& path) {
    const Extent extent = image.extent();
    if (index == 0) all = HostImage(image.format(), {extent.widthPx, extent.heightPx * int(count)});
    const Extent first{all.extent().widthPx, all.extent().heightPx / int(count)};
    if (extent != first)
        throw InputError(fmt::format("{}: {}x{} pixels, but that of the first light has {}x{}", path.string(),
                                     extent.widthPx, extent.heightPx, first.widthPx, first.heightPx));
    std::memcpy(all.data() + index * image.sizeBytes(), image.data(), image.sizeBytes());
}

}  // namespace

void writeInputs(const fs::path& folder, const FrameInputs& frame) {
    if (frame.lights.size() != frame.lightMaps.size())
        throw UsageError(
            fmt::format("writeInputs: {} lights but {} sets of maps", frame.lights.size(), frame.lightMaps.size()));
    InputsDescription description{frame.camera, {}, frame.lights, {}};
    const auto write = [&](ImageFiles& files, const ImageSpec& spec, const ImageView& image, const std::string& file) {
        if (image.empty() || image.format != spec.format)
            throw UsageError(
                fmt::format("writeInputs: image '{}' is empty or not {}", spec.key, formatName(spec.format)));
        const Layer layer{"", image, channelNames(spec.kind)};
        writeExr(folder / file, {&layer, 1});
        files[spec.key] = file;
    };
    const GBuffer& g = frame.gbuffer;
    write(description.images, kAlbedo, g.albedo, "albedo.exr");
    write(description.images, kNormal, g.normalWs, "normal.exr");
    write(description.images, kDepth, g.depth, "depth.exr");
    if (!g.motion.empty()) write(description.images, kMotion, g.motion, "motion.exr");
    if (!g.emission.empty()) write(description.images, kEmission, g.emission, "emission.exr");
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        const LightMaps& maps = frame.lightMaps[i];
        ImageFiles& files = description.lightMaps.emplace_back();
        write(files, kRsmDepth, maps.rsmDepth, fmt::format("rsm_{}_depth.exr", i));
        write(files, kRsmNormal, maps.rsmNormalWs, fmt::format("rsm_{}_normal.exr", i));
        write(files, kRsmFlux, maps.rsmFlux, fmt::format("rsm_{}_flux.exr", i));
        write(files, kShadowDepth, maps.shadowDepth, fmt::format("shadow_{}.exr", i));
    }
    std::ofstream stream(folder / kInputsFile, std::ios::binary);
    stream << writeDescription(description) << std::flush;
    if (!stream) throw Error(fmt::format("{}: cannot be written", (folder / kInputsFile).string()));
}

void saveInputs(const fs::path& folder, const FrameInputs& frame) {
    OutputSet outputs;
    writeInputs(outputs.addFolder(folder, kInputsFile), frame);
    outputs.commit();
}

FrameImages loadInputs(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) throw InputError(fmt::format("{}: no such folder", folder.string()));
    const InputsDescription description = readDescription(folder / kInputsFile);
    FrameImages frame;
    frame.camera = description.camera;
    frame.lights = description.lights;
    const auto read = [&](const ImageFiles& files, const ImageSpec& spec, const HostImage* depth) {
        const auto file = files.find(spec.key);
        return file == files.end() ? HostImage() : readImage(folder / file->second, spec, depth);
    };
    frame.depth = read(description.images, kDepth, nullptr);
    frame.albedo = read(description.images, kAlbedo, &frame.depth);
    frame.normalWs = read(description.images, kNormal, &frame.depth);
    frame.motion = read(description.images, kMotion, &frame.depth);
    frame.emission = read(description.images, kEmission, &frame.depth);
    const std::size_t count = description.lights.size();
    for (std::size_t i = 0; i < count; ++i) {
        const ImageFiles& files = description.lightMaps[i];
        const HostImage depth = read(files, kRsmDepth, nullptr);
        stack(frame.rsmDepth, depth, i, count, folder / files.at(kRsmDepth.key));
        stack(frame.rsmNormalWs, read(files, kRsmNormal, &depth), i, count, folder / files.at(kRsmNormal.key));
        stack(frame.rsmFlux, read(files, kRsmFlux, &depth), i, count, folder / files.at(kRsmFlux.key));
        stack(frame.shadowDepth, read(files, kShadowDepth, nullptr), i, count, folder / files.at(kShadowDepth.key));
    }
    return frame;
}

}  // namespace earthshine
