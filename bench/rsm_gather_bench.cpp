// rsm_gather: the disk estimator, whose cost a sample is what its number of samples, 4 to 64, shows; with and without
// packing the records that it gathers from; and as all pixels gather the same pattern. rsm_choose,
// rsm_gather_coherent: as sets of pixels gather the same texels, each kernel alone and (rsm_gather.*.coherent) both.

#include <fmt/format.h>

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "gather_flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/blue_noise.hpp"
#include "stages/frame_params.hpp"
#include "stages/rsm_choose_stage.hpp"
#include "stages/rsm_gather_coherent_stage.hpp"
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

/// What a coherent gather runs on: its stages and its choices, of all rows at once.
struct Coherent {
    Coherent(const Variant& variant, Extent extent, int sampleCount)
        : room(variant, extent),
          out(room.three()),
          pattern(room.device.impl().upload(makeDiskPattern(sampleCount))),
          noise(room.device.impl().upload(makeRotationNoise())),
          sets(double(choicesInRow(extent.widthPx, 1)) * extent.heightPx),
          choices(room.device.impl().makeBuffer(sizeof(RsmChoice) * std::size_t(sets) * std::size_t(sampleCount) *
                                                std::size_t(room.inputs.rsm.lightCount))),
          choose(room.device),
          gather(room.device) {
        settings.sampleCount = sampleCount;
        settings.rotation = Rotation::Coherent;
        settings.radiusUv = 0.3f;  // as the other rows
        params = room.params(settings).choose;
        params.rowCount = extent.heightPx;
        if (room.device.tuning().rsmRecords) RsmPackStage(room.device).enqueue(room.inputs.rsm, room.inputs.lights);
        enqueueChoose();
        room.device.impl().finish();
    }
    void enqueueChoose() {
        const FrameSurfaces& i = room.inputs;
        choose.enqueue({i.depth, i.lights, pattern, noise, choices}, params);
    }
    void enqueueGather() {
        const FrameSurfaces& i = room.inputs;
        gather.enqueue({i.normalWs, i.depth, i.rsm, i.lights, choices, out}, params);
    }
    // bytes: depth, the choices.
    Work chooseWork() const {
        const double choiceBytes = sizeof(RsmChoice) * sets * settings.sampleCount;
        return {.bytes = room.bytes({room.inputs.depth}) + choiceBytes, .flops = chooseFlops(settings) * sets};
    }
    // bytes: depth and out at every pixel, normals where there is no sky, the choices; of the map what they name.
    Work gatherWork() const {
        const double choiceBytes = sizeof(RsmChoice) * sets * settings.sampleCount;
        return {.bytes = room.bytes({room.inputs.depth, out}, {room.inputs.normalWs}) + choiceBytes +
                         room.rsmBytes(sets * settings.sampleCount),
                .flops = coherentGatherFlops(settings) * room.seenPixels};
    }

    Room room;
    Settings settings;
    RsmChooseParams params{};
    Surface out;
    cl::Buffer pattern, noise;
    double sets;
    cl::Buffer choices;
    RsmChooseStage choose;
    RsmGatherCoherentStage gather;
};

Row coherent(const Variant& variant, Extent extent, int sampleCount, bool chooses, bool gathers) {
    const auto c = std::make_shared<Coherent>(variant, extent, sampleCount);
    Row row{.device = c->room.device, .run = launches(c->room.device, [=] {
                                          if (chooses) c->enqueueChoose();
                                          if (gathers) c->enqueueGather();
                                      })};
    row.pixels = c->room.pixels;
    row.samples = sampleCount;
    const Work choose = chooses ? c->chooseWork() : Work{}, gather = gathers ? c->gatherWork() : Work{};
    row.work = {.bytes = choose.bytes + gather.bytes, .flops = choose.flops + gather.flops};
    row.showsStages = chooses && gathers;
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
    const auto addCoherent = [](const char* stage, const Extents& extents, int sampleCount, const char* setting,
                                bool chooses, bool gathers) {
        addRows(stage, extents, fmt::format("{}spp{}", sampleCount, setting),
                [=](const Variant& variant, Extent extent) {
                    return coherent(variant, extent, sampleCount, chooses, gathers);
                });
    };
    addCoherent("rsm_gather", usualExtents(), 8, "_coherent", true, true);
    addCoherent("rsm_choose", usualExtents(), 8, "", true, false);
    addCoherent("rsm_gather_coherent", usualExtents(), 8, "", false, true);
    for (const int sampleCount : {4, 16, 32, 64})
        add({{{1920, 1080}}}, fmt::format("{}spp", sampleCount), {sampleCount});
}

}  // namespace earthshine::bench
