// atrous: passes of the filter, each with all its taps: history of one frame, which fades nothing (kernels/atrous.cl).

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/atrous_stage.hpp"

namespace earthshine::bench {

namespace {

// A pixel: fade; four dot products of its plane, its ray, how far that runs along the normal, its cosine (rsqrt, two *,
// max); the reach and what few frames make of it, 1 / reach; luminance; the centre's share, the mean.
constexpr double kPixel =
    3 + 4 * kDot3 + 2 * kMad3 + kDot3 + (kDot3 + 4) + (kFma + 1) + 4 + 2 + kLuminance + kScale3 + 1 + kScale3;
// A tap: how its normal turned; distance from the plane; t of that, of the turn, and of luminance; (1 - t)^2; its
// share; sums.
constexpr double kTap =
    kSub3 + (5 * kFma + 1) + (1 + kFma + kDot3 + 1) + (kLuminance + 1 + 1 + kFma) + 3 + 2 + 1 + kMad3;

// bytes: depth and out at every pixel; irradiance, normals and length where there is no sky.
Row atrous(const Variant& variant, Extent extent, FilterKernel kernel, std::size_t pass) {
    const Room room(variant, extent);
    const Surface in = room.noisy(), out = room.three(), length = room.constant(1.0f), moment = room.constant(1e5f);
    Settings settings = settingsOf(Preset::Balanced);
    settings.filterKernel = kernel;
    const AtrousParams params = room.params(settings, true).filterPasses.at(pass);
    const int taps = (2 * params.radiusX + 1) * (2 * params.radiusY + 1) - 1;
    const auto stage = std::make_shared<AtrousStage>(room.device);
    return {.device = room.device,
            .run = launches(room.device,
                            [=] {
                                const FrameSurfaces& i = room.inputs;
                                stage->enqueue({in, i.normalWs, i.depth, length, moment, out}, params);
                            }),
            .work = {.bytes = room.bytes({room.inputs.depth, out}, {in, room.inputs.normalWs, length}),
                     .flops = (kPixel + taps * kTap) * room.seenPixels}};
}

}  // namespace

void addAtrousRows() {
    const auto add = [](const char* setting, FilterKernel kernel, std::size_t pass) {
        addRows("atrous", usualExtents(), setting,
                [=](const Variant& variant, Extent extent) { return atrous(variant, extent, kernel, pass); });
    };
    add("row_step1", FilterKernel::Separable, 0);
    add("column_step1", FilterKernel::Separable, 1);
    add("row_step4", FilterKernel::Separable, 4);
    add("column_step4", FilterKernel::Separable, 5);
    add("3x3_step1", FilterKernel::Square3x3, 0);
    add("5x5_step1", FilterKernel::Square5x5, 0);
}

}  // namespace earthshine::bench
