// rsm_gather: the disk estimator, whose cost a sample is what its number of samples, 4 to 64, shows; with and without
// packing the records that it gathers from; and as all pixels gather the same pattern.

#include <fmt/format.h>

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "gather_flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/blue_noise.hpp"
#include "stages/frame_params.hpp"
#include "stages/rsm_gather_stage.hpp"
#include "stages/rsm_pack_stage.hpp"

namespace earthshine::bench {

namespace {

struct Setting {
    int sampleCount;
    Rotation rotation = Rotation::Noise;
    bool packs = false;
};

// bytes: depth and out at every pixel, normals where there is no sky, of the map what samples
// read, at most all of it once.
Row gather(const Variant& variant, Extent extent, const Setting& setting) {
    const Room room(variant, extent);
    const Surface out = room.three();
    Settings settings;
    settings.sampleCount = setting.sampleCount;
    settings.rotation = setting.rotation;
    settings.radiusUv = 0.3f;  // a disk that stays on the map: every sample costs its full price
    const RsmGatherParams params = room.params(settings).gather;
    const cl::Buffer pattern = room.device.impl().upload(makeDiskPattern(setting.sampleCount));
    const cl::Buffer noise = room.device.impl().upload(makeRotationNoise());
    const bool hasRecords = room.device.tuning().rsmRecords;
    const auto packStage = std::make_shared<RsmPackStage>(room.device);
    const auto stage = std::make_shared<RsmGatherStage>(room.device);
    if (hasRecords) packStage->enqueue(room.inputs.rsm, room.inputs.lights);
    Row row{.device = room.device,
            .run = launches(room.device, [=] {
                const FrameSurfaces& i = room.inputs;
                if (setting.packs && hasRecords) packStage->enqueue(i.rsm, i.lights);
                stage->enqueue({i.normalWs, i.depth, i.rsm, i.lights, pattern, noise, out}, params);
            })};
    row.pixels = room.pixels;
    row.samples = setting.sampleCount;
    if (!setting.packs)
        row.work = {.bytes = room.bytes({room.inputs.depth, out}, {room.inputs.normalWs}) +
                             room.rsmBytes(room.seenPixels * setting.sampleCount),
                    .flops = gatherFlops(hasRecords, settings) * room.seenPixels};
    return row;
}

}  // namespace

void addRsmGatherRows() {
    const auto add = [](const Extents& extents, const std::string& name, const Setting& setting) {
        addRows("rsm_gather", extents, name,
                [=](const Variant& variant, Extent extent) { return gather(variant, extent, setting); });
    };
    add(usualExtents(), "8spp", {8});
    add(usualExtents(), "8spp_packing", {8, Rotation::Noise, true});
    add(usualExtents(), "8spp_same_pattern", {8, Rotation::Off});
    for (const int sampleCount : {4, 16, 32, 64})
        add({{{1920, 1080}}}, fmt::format("{}spp", sampleCount), {sampleCount});
}

}  // namespace earthshine::bench
