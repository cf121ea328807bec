#include "compute/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compute/quirks.hpp"
#include "earthshine/error.hpp"

namespace earthshine {

const char* storageName(Storage storage) {
    return storage == Storage::Image ? "image" : "planar";
}

namespace {
constexpr const char* kSurfaceFormats[] = {"R32F", "RGBA16F", "RGBA32F"};
}

Tuning defaultTuning(const DeviceCaps& caps) {
    Tuning t;
    const bool hasImages = std::all_of(std::begin(kSurfaceFormats), std::end(kSurfaceFormats), [&](const char* format) {
        return std::find(caps.imageFormats.begin(), caps.imageFormats.end(), format) != caps.imageFormats.end();
    });
    if (runsOnLlvmpipe(caps)) {
        // Mesa's llvmpipe vectorises across work-items by itself, and its texture unit is its fast path.
        t.lanes = 1;
        t.storage = hasImages ? Storage::Image : Storage::Planar;
        t.localSizePx[0] = 8;
        t.localSizePx[1] = 8;
        t.reason = "rusticl on llvmpipe";
    } else if (caps.type == "CPU") {
        // Vectors as wide as the registers, whole cache lines of planes. Groups as wide as a row of a picture: a thread
        // walks along rows, whose memory comes in ahead of it (18 % faster filters at 1920 x 1080 than groups of 4 x
        // 2).
        t.lanes = caps.nativeFloatWidth >= 16 ? 16 : caps.nativeFloatWidth >= 8 ? 8 : 4;
        t.storage = Storage::Planar;
        t.localSizePx[0] = 64;
        t.localSizePx[1] = 4;
        t.reason = fmt::format("CPU with a native width of {} floats", caps.nativeFloatWidth);
    } else {
        t.lanes = 1;
        t.storage = hasImages ? Storage::Image : Storage::Planar;
        t.localSizePx[0] = 16;
        t.localSizePx[1] = 8;
        t.reason = caps.type;
    }
    t.reason += fmt::format(": {} pixel{} a work-item, {}", t.lanes, t.lanes == 1 ? "" : "s",
                            t.storage == Storage::Image ? "images"
                            : hasImages                 ? "planes"
                                                        : "planes for want of images");
    const int maxItems = int(std::max<std::size_t>(caps.maxWorkGroupSize, 1));
    t.localSizePx[0] = std::min(t.localSizePx[0], maxItems);
    t.localSizePx[1] = std::min(t.localSizePx[1], maxItems / t.localSizePx[0]);
    return t;
}

Tuning tuningFor(const DeviceCaps& caps, const DeviceOptions& options) {
    Tuning t = defaultTuning(caps);
    if (options.lanes != 0) {
        if (options.lanes != 1 && options.lanes != 4 && options.lanes != 8 && options.lanes != 16)
            throw UsageError(fmt::format("lanes: {} is none of 1, 4, 8, 16", options.lanes));
        t.lanes = options.lanes;
        t.reason = "asked for";
    }
    if (!options.storage.empty()) {
        if (options.storage != "image" && options.storage != "planar")
            throw UsageError(fmt::format("storage: '{}' is neither image nor planar", options.storage));
        t.storage = options.storage == "image" ? Storage::Image : Storage::Planar;
        t.reason = "asked for";
    }
    if (t.storage == Storage::Image && !caps.images)
        throw UsageError(fmt::format("storage: \"{}\" has no images; use planar", caps.name));
    if (options.rsmRecords >= 0) t.rsmRecords = options.rsmRecords != 0;
    for (int i = 0; i < 2; ++i) {
        if (options.localSizePx[i] < 0) throw UsageError("local size: must not be negative");
        if (options.localSizePx[i] > 0) t.localSizePx[i] = options.localSizePx[i];
    }
    if (std::size_t(t.localSizePx[0]) * std::size_t(t.localSizePx[1]) > std::max<std::size_t>(caps.maxWorkGroupSize, 1))
        throw UsageError(fmt::format("local size: {} x {} is more than the {} work-items of \"{}\"", t.localSizePx[0],
                                     t.localSizePx[1], caps.maxWorkGroupSize, caps.name));
    return t;
}

}  // namespace earthshine
