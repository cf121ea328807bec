// rsm_pack, rsm_minify: the RSM's maps into records, whatever then gathers from them. rsm_sum: every texel at every
// pixel, on a small picture and a small map, since it is slow by its nature.

#include <fmt/format.h>

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/rsm_minify_stage.hpp"
#include "stages/rsm_pack_stage.hpp"
#include "stages/rsm_sum_stage.hpp"

namespace earthshine::bench {

namespace {

constexpr Extent kAnyExtent{64, 36};  // of the picture, which these stages do not read

// bytes: three maps in, records out. A texel: place, radius and its limit, flux, the record.
Row pack(const Variant& variant, Extent map) {
    const Room room(withRecords(variant), kAnyExtent, false, map.widthPx);
    const RsmView& rsm = room.inputs.rsm;
    const auto stage = std::make_shared<RsmPackStage>(room.device);
    const double texels = double(map.widthPx) * map.heightPx;
    return {.device = room.device,
            .run = launches(room.device, [=] { stage->enqueue(room.inputs.rsm, room.inputs.lights); }),
            .work = {.bytes = room.bytes({rsm.depth, rsm.normalWs, rsm.flux}) + sizeof(RsmRecord) * texels,
                     .flops = (kPositionFromDepth + kTexelRadius + 1 + kPositiveFlux + kStoreRecord) * texels}};
}

// bytes: as of rsm_pack, one record a block. A texel is looked at twice: flux, its sum, place, radius and its limit,
// sums of flux, weight and area; then flux and the running sum. A block: its random threshold, the picked texel's
// place, the radius of the area, the record.
Row minify(const Variant& variant, Extent map, int blockPx) {
    constexpr double kFirstLook = kPositiveFlux + 2 + kPositionFromDepth + kTexelRadius + 1 + kAdd3 + 1 + 2;
    constexpr double kSecondLook = kPositiveFlux + 2 + 1;
    constexpr double kBlock = 2 + kPositionFromDepth + 2 + kStoreRecord;
    const Room room(withRecords(variant), kAnyExtent, false, map.widthPx);
    const RsmView& rsm = room.inputs.rsm;
    Settings settings;
    settings.rsmMinify = blockPx;
    const RsmPackParams params = room.params(settings).pack;
    const auto stage = std::make_shared<RsmMinifyStage>(room.device);
    const double texels = double(map.widthPx) * map.heightPx, blocks = texels / (blockPx * blockPx);
    return {.device = room.device,
            .run = launches(room.device, [=] { stage->enqueue(room.inputs.rsm, room.inputs.lights, params); }),
            .work = {.bytes = room.bytes({rsm.depth, rsm.normalWs, rsm.flux}) + sizeof(RsmRecord) * blocks,
                     .flops = (kFirstLook + kSecondLook) * texels + kBlock * blocks}};
}

// bytes: depth, normal, map and out: nothing beside the arithmetic. A texel is the same for all pixels of a work-item,
// and so is what its own numbers cost; a pair of pixel and texel: geometry and flux. rsmGather of three maps is the
// lanes' own, and counts.
Row sum(const Variant& variant, Extent extent) {
    constexpr int kMapPx = 128;
    const Room room(variant, extent, false, kMapPx);
    const Surface out = room.three();
    const RsmSumParams params = room.params(Settings()).sum;
    if (room.device.tuning().rsmRecords) RsmPackStage(room.device).enqueue(room.inputs.rsm, room.inputs.lights);
    const auto stage = std::make_shared<RsmSumStage>(room.device);
    const double pairs = room.seenPixels * kMapPx * kMapPx;
    const double perPair = kTexelGeometry + kMad3 + (room.device.tuning().rsmRecords ? 0.0 : kTexelOfMaps);
    return {.device = room.device,
            .run = launches(room.device,
                            [=] {
                                const FrameSurfaces& i = room.inputs;
                                stage->enqueue({i.normalWs, i.depth, i.rsm, i.lights, out}, params, extent.heightPx);
                            }),
            .work = {.bytes = room.bytes({room.inputs.depth, out}, {room.inputs.normalWs}) +
                              room.rsmBytes(double(kMapPx) * kMapPx),
                     .flops = perPair * pairs}};
}

}  // namespace

void addRsmRows() {
    const Extents map{{{kRsmSizePx, kRsmSizePx}}, true}, small{{{160, 90}}, true};
    addRows("rsm_pack", map, "", pack);
    for (const int blockPx : {2, 4, 8})
        addRows("rsm_minify", map, fmt::format("1_{}", blockPx),
                [=](const Variant& variant, Extent extent) { return minify(variant, extent, blockPx); });
    addRows("rsm_sum", small, "128px", sum);
}

}  // namespace earthshine::bench
