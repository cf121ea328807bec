// direct_light: one directional light behind its shadow map.

#include <algorithm>
#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/direct_light_stage.hpp"

namespace earthshine::bench {

namespace {

// A directional light: its cosine; the place on its map (w, 1 / w, u and v scaled twice); depth; tan of the slope
// (c c, 1 - , max, sqrt, max, /, min); the bias; e max(c, 0), added up.
constexpr double kLight =
    kDot3 + (kRowTimesPoint + 2) + 2 * (kRowTimesPoint + 2) + kRowTimesPoint + 7 + (kFma + 1) + 1 + 2 + kMad3;

// bytes: depth and out at every pixel, normals where there is no sky, a texel of the shadow map for
// each pixel, at most all of it.
Row directLight(const Variant& variant, Extent extent) {
    const Room room(variant, extent);
    const Surface out = room.three();
    const DirectLightParams params = room.params(Settings()).directLight;
    const auto stage = std::make_shared<DirectLightStage>(room.device);
    const FrameSurfaces& in = room.inputs;
    const double shadowBytes = std::min(sizeof(float) * room.seenPixels, double(in.shadowDepth.sizeBytes()));
    return {.device = room.device,
            .run = launches(room.device,
                            [=] {
                                const FrameSurfaces& i = room.inputs;
                                stage->enqueue({i.normalWs, i.depth, i.shadowDepth, i.lights, out}, params);
                            }),
            .work = {.bytes = room.bytes({in.depth, out}, {in.normalWs}) + shadowBytes,
                     .flops = (kPositionFromDepth + kLight) * room.seenPixels}};
}

}  // namespace

void addDirectLightRows() {
    addRows("direct_light", usualExtents(), "1light", directLight);
}

}  // namespace earthshine::bench
