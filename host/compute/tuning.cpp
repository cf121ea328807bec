#include "compute/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compute/tuning_table.hpp"
#include "earthshine/error.hpp"

namespace earthshine {

namespace {

constexpr const char* kSurfaceFormats[] = {"R32F", "RGBA16F", "RGBA32F"};

void clampGroup(int (&localSizePx)[2], std::size_t maxItems) {
    const int most = int(std::max<std::size_t>(maxItems, 1));
    localSizePx[0] = std::clamp(localSizePx[0], 1, most);
    localSizePx[1] = std::clamp(localSizePx[1], 1, most / localSizePx[0]);
}

}  // namespace

const char* storageName(Storage storage) {
    return kStorageNames[int(storage)];
}

std::optional<Storage> storageOf(std::string_view name) {
    const auto* const at = std::find(std::begin(kStorageNames), std::end(kStorageNames), name);
    if (at == std::end(kStorageNames)) return std::nullopt;
    return Storage(at - std::begin(kStorageNames));
}

Tuning defaultTuning(const DeviceCaps& caps, const std::string& file) {
    Tuning t = lookUpTuning(tuningRows(file), caps);
    const bool hasImages = std::all_of(std::begin(kSurfaceFormats), std::end(kSurfaceFormats), [&](const char* format) {
        return std::find(caps.imageFormats.begin(), caps.imageFormats.end(), format) != caps.imageFormats.end();
    });
    const bool wantsImages = t.storage == Storage::Image;
    if (wantsImages && !hasImages) t.storage = Storage::Planar;
    t.reason += fmt::format(": {} pixel{} a work-item, {}", t.lanes, t.lanes == 1 ? "" : "s",
                            t.storage == Storage::Image    ? "images"
                            : t.storage == Storage::Packed ? "packed pixels"
                            : !wantsImages                 ? "planes"
                                                           : "planes for want of images");
    clampGroup(t.localSizePx, caps.maxWorkGroupSize);
    for (Tuning::Group& group : t.groups) clampGroup(group.localSizePx, caps.maxWorkGroupSize);
    return t;
}

Tuning tuningFor(const DeviceCaps& caps, const DeviceOptions& options) {
    Tuning t = defaultTuning(caps, options.tuningFile);
    if (options.lanes != 0) {
        if (options.lanes != 1 && options.lanes != 4 && options.lanes != 8 && options.lanes != 16)
            throw UsageError(fmt::format("lanes: {} is none of 1, 4, 8, 16", options.lanes));
        t.lanes = options.lanes;
        t.reason = "asked for";
    }
    if (!options.storage.empty()) {
        const std::optional<Storage> storage = storageOf(options.storage);
        if (!storage)
            throw UsageError(
                fmt::format("storage: '{}' is none of {}", options.storage, fmt::join(kStorageNames, ", ")));
        t.storage = *storage;
        t.reason = "asked for";
    }
    if (t.storage == Storage::Image && !caps.images)
        throw UsageError(fmt::format("storage: \"{}\" has no images; use planar or packed", caps.name));
    if (options.rsmRecords >= 0) t.rsmRecords = options.rsmRecords != 0;
    if (options.filterPairs >= 0) t.filterPairs = options.filterPairs != 0;
    for (int i = 0; i < 2; ++i) {
        if (options.localSizePx[i] < 0) throw UsageError("local size: must not be negative");
        if (options.localSizePx[i] == 0) continue;
        t.localSizePx[i] = options.localSizePx[i];
        t.groups.clear();
    }
    if (std::size_t(t.localSizePx[0]) * std::size_t(t.localSizePx[1]) > std::max<std::size_t>(caps.maxWorkGroupSize, 1))
        throw UsageError(fmt::format("local size: {} x {} is more than the {} work-items of \"{}\"", t.localSizePx[0],
                                     t.localSizePx[1], caps.maxWorkGroupSize, caps.name));
    return t;
}

std::array<int, 2> localSizeOf(const Tuning& tuning, const std::string& kernel) {
    for (const Tuning::Group& group : tuning.groups)
        if (group.kernel == kernel) return {group.localSizePx[0], group.localSizePx[1]};
    return {tuning.localSizePx[0], tuning.localSizePx[1]};
}

}  // namespace earthshine
