// tile_average: 4 x 4 pixels' mean, as far as they lie on one surface.

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/tile_average_stage.hpp"

namespace earthshine::bench {

namespace {

// A pixel: the reach, four dot products of its plane, its ray and how far that runs along the normal, the mean.
constexpr double kPixel = (kFma + 1) + 4 * kDot3 + 2 * kMad3 + kDot3 + kScale3 + 1 + kScale3;
// Each of 15 taps: distance from the plane, the reach there, the cosine, count and sum.
constexpr double kTap = 5 * kFma + 1 + kDot3 + 1 + kMad3;

// bytes: depth and out at every pixel, irradiance and normals where there is no sky.
Row tileAverage(const Variant& variant, Extent extent) {
    const Room room(variant, extent);
    const Surface in = room.noisy(), out = room.three();
    const TileAverageParams params = room.params(Settings()).tileAverage;
    const auto stage = std::make_shared<TileAverageStage>(room.device);
    return {.device = room.device,
            .run = launches(room.device,
                            [=] {
                                stage->enqueue({in, room.inputs.normalWs, room.inputs.depth, out}, params);
                            }),
            .work = {.bytes = room.bytes({room.inputs.depth, out}, {in, room.inputs.normalWs}),
                     .flops = (kPixel + 15 * kTap) * room.seenPixels}};
}

}  // namespace

void addTileAverageRows() {
    addRows("tile_average", usualExtents(), "", tileAverage);
}

}  // namespace earthshine::bench
