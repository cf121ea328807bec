// temporal, at rest and where every pixel moves by a fraction; history_check and history_confidence, which judge it.

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/history_check_stage.hpp"
#include "stages/temporal_stage.hpp"

namespace earthshine::bench {

namespace {

// The plane as it was seen: slope and offset, each a step along x and y. Is a tap on it: its distance at the point,
// then a step along x and y, against a tolerance; how its normal turned. And what it adds, as far as it is alike.
constexpr double kSeenPlane = 4 * kDot3 + (kDot3 + 2 * kFma), kTap = 2 + 4 * kFma + 1 + (kSub3 + kDot3 + 2);
constexpr double kAddTap = 1 + 1 + kMad3 + 2 + 2 * kFma;  // of the moment's zero too
// 1 / weight, history by it, the new length and share, blend, change of luminance. (No confidence, no moments.)
constexpr double kBlend = 2 + 3 + 1 + 2 + 1 + kSub3 + kMad3 + 2 * kLuminance + 1;
// Depth then; the plane; a tap, as far as it is alike.
constexpr double kStill = 2 + kSeenPlane + kTap + kScale3 + 3 + kBlend;
// The same; where it was, kept in range; four taps, each with its place and bilinear weight.
constexpr double kMoving = 2 + kSeenPlane + 6 + 2 + 4 * (2 + kTap + 3 + kAddTap) + kBlend;

// bytes: depth and three outputs at every pixel; the estimate, normals, motion (which a GPU reads on sky too), the
// previous frame's normals and depths and history where there is no sky. Taps that moving pixels share count once; none
// is lost, none is rescued.
Row temporal(const Variant& variant, Extent extent, bool moves) {
    const Room room(variant, extent, moves);
    const Surface in = room.noisy(), out = room.three(), outLength = room.one(), outChange = room.one();
    const HistorySurfaces history{room.noisy(), room.constant(8.0f), {}};
    const Extent tiles = HistoryCheckStage::tiles(extent);
    const cl::Buffer confidence =
        room.device.impl().upload(std::vector<float>(std::size_t(tiles.widthPx) * std::size_t(tiles.heightPx), 1.0f));
    const FrameSurfaces previous = room.another();
    const TemporalParams params = room.params(settingsOf(Preset::Balanced), true).temporal;
    const auto stage = std::make_shared<TemporalStage>(room.device);
    const FrameSurfaces& i = room.inputs;
    double bytes = room.bytes({i.depth, out, outLength, outChange},
                              {in, i.normalWs, previous.normalWs, previous.depth, history.irradiance, history.length});
    if (moves) bytes += room.bytes({}, {i.motion});
    return {.device = room.device,
            .run = launches(room.device,
                            [=] {
                                const FrameSurfaces& now = room.inputs;
                                stage->enqueue(
                                    {in, now.normalWs, now.depth, moves ? &now.motion : nullptr, previous.normalWs,
                                     previous.depth, history, confidence, out, outLength, Surface(), outChange},
                                    params);
                            }),
            .work = {.bytes = bytes, .flops = (moves ? kMoving : kStill) * room.seenPixels}};
}

// history_check: bytes: the changes, and two sums a tile; a pixel: two sums. history_confidence: bytes: the sums in,
// one number out a tile; a tile: sums over 3 x 3, two confidences (a ratio, a slope, a clamp), the lesser.
Row historyCheck(const Variant& variant, Extent extent, bool isConfidence) {
    constexpr double kPixel = 1 + kFma, kTile = 9 * 2 + 2 * 6 + 1;
    constexpr double kSums = 2 * sizeof(float);  // bytes a tile
    const Room room(variant, extent);
    const Surface change = room.constant(1.0f);
    const Extent tiles = HistoryCheckStage::tiles(extent);
    const double tileCount = double(tiles.widthPx) * tiles.heightPx;
    const cl::Buffer confidence = room.device.impl().makeBuffer(sizeof(float) * std::size_t(tileCount));
    const HistoryCheckParams params = room.params(settingsOf(Preset::Balanced), true).historyCheck;
    const auto stage = std::make_shared<HistoryCheckStage>(room.device);
    return {.device = room.device,
            .run = launches(
                room.device,
                [=] {
                    stage->enqueue({change, confidence}, params);
                },
                isConfidence ? "history_confidence" : "history_check"),
            .work = isConfidence ? Work{(kSums + 4) * tileCount, kTile * tileCount}
                                 : Work{room.bytes({change}) + kSums * tileCount, kPixel * room.pixels}};
}

}  // namespace

void addTemporalRows() {
    addRows("temporal", usualExtents(), "still",
            [](const Variant& variant, Extent extent) { return temporal(variant, extent, false); });
    addRows("temporal", usualExtents(), "moving",
            [](const Variant& variant, Extent extent) { return temporal(variant, extent, true); });
    addRows("history_check", usualExtents(), "",
            [](const Variant& variant, Extent extent) { return historyCheck(variant, extent, false); });
    // Microseconds of the device's after milliseconds of history_check: by its own time alone it would run for minutes.
    constexpr int kRuns = 100;
    addRows(
        "history_confidence", usualExtents(), "",
        [](const Variant& variant, Extent extent) { return historyCheck(variant, extent, true); }, kRuns);
}

}  // namespace earthshine::bench
